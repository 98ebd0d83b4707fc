"""Changes of a TIN: operations on its inputs, their history, and a mesh changed in place."""
