"""Drawings and design data: LandXML and DXF."""
