"""LandXML 1.0 to 2.0: surfaces, their source data and survey points."""
