"""The terrain as one self-contained HTML page, drawn by WebGL in any browser, offline."""
