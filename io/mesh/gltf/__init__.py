"""glTF: surfaces for viewers and game engines."""
