"""The formats of survey instruments."""

from collections.abc import Callable

from ..registry.format import Format
from .signatures import is_dc, is_gsi, is_jobxml, is_sdr

__all__ = ["FORMATS"]


def _make(name: str, description: str, suffix: str, sniff: Callable[[bytes], bool]) -> Format:
    """Describe a format of an instrument."""
    read = f"{__package__}.instruments.reading:read_{name}"
    return Format(
        name=name, description=description, suffixes=(suffix,), read=read, writes=(), sniff=sniff
    )


FORMATS = (
    _make("gsi", "Leica GSI-8 and GSI-16: points of a total station", ".gsi", is_gsi),
    _make(
        "sdr",
        "Sokkia SDR20 and SDR33, of Topcon and Nikon too: points of a total station",
        ".sdr",
        is_sdr,
    ),
    _make("jobxml", "Trimble JobXML: points of a survey job", ".jxl", is_jobxml),
    _make("dc", "Trimble DC of Survey Controller and Access: points of a survey job", ".dc", is_dc),
)
