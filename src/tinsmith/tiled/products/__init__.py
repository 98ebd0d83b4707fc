"""Products of tiles: what a task computes, and how the whole is joined, a module each."""
