"""Changes of a TIN: operations on its inputs, their history, and a mesh changed in place."""

from .accounts import account_for_edits, account_for_removed, renumber_vertices

__all__ = ["account_for_edits", "account_for_removed", "renumber_vertices"]
