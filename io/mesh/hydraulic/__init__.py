"""Meshes of hydraulic and coastal models: 2DM, ADCIRC and SCHISM, Selafin of TELEMAC."""
