"""IFC: terrain for programs of building information modelling."""
