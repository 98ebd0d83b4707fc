"""Drawing: what pages, plans, charts and notebooks share: lines, numbers, 3D models, HTML."""
