"""Mesh formats: PLY, OBJ, STL, VTK, Gmsh."""
