"""DXF drawings through ezdxf: faces, points and lines by layer."""
