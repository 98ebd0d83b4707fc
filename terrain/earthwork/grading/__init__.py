"""Surfaces put into others: pasted, and graded pads with their side slopes."""

from .balances import BalancedPad, balance
from .grades import grade
from .merging import merge
from .pasting import paste

__all__ = ["BalancedPad", "balance", "grade", "merge", "paste"]
