"""Surfaces put into others: pasted, and graded pads with their side slopes."""

from .balances import BalancedPad, balance
from .grades import grade
from .pasting import paste

__all__ = ["BalancedPad", "balance", "grade", "paste"]
