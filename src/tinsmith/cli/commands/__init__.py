"""The commands, one module each, in folders by their subject in the help."""
