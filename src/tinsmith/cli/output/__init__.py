"""What a command says: results, summaries, progress, failures."""

from .counts import describe_counts, mesh_counts
from .facts import Facts, describe_features, list_rows, name_unit, name_units

__all__ = [
    "Facts",
    "describe_counts",
    "describe_features",
    "list_rows",
    "mesh_counts",
    "name_unit",
    "name_units",
]
