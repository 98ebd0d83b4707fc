"""Proof that a TIN is what it says: levels of checks that trust nobody who made it."""
