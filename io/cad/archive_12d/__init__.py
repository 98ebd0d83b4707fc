"""Archives of 12d Model (.12da): tins, strings, points."""
