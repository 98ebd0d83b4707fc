"""Plan sheets: a surface on paper, true to scale, as PDF, SVG and PNG."""

from .production import Plan, plan

__all__ = ["Plan", "plan"]
