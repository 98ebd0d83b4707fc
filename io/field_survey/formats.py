"""The formats of survey instruments, and what the first bytes of their files say."""

import re
from collections.abc import Callable

from ..registry import Format

_GSI = re.compile(
    rb"(?:\xef\xbb\xbf)?\s*(?:\*?(?:11|41)[\d.]{4}[+-][^\s,;]{8}(?:[^\s,;]{8})?"
    rb"(?:[ \t]*[\r\n]|[ \t]*\Z| (?:\d\d[\d.]|\d{3})[\d.]{3}[+-]))"
)
_SDR = re.compile(rb"(?:\xef\xbb\xbf)?[\x02\s]*00[A-Z]{2}SDR[23]\d", re.IGNORECASE)
_DC = re.compile(rb"(?:\xef\xbb\xbf)?[\x02\s]*00[A-Z]{2}(?:SC|DC) ?V\d", re.IGNORECASE)
_JOBXML = re.compile(rb"<JOBFile[\s>]")


def is_gsi(head: bytes) -> bool:
    """Whether the file is certainly Leica GSI: a word of a point or code, and another."""
    return _GSI.match(head) is not None


def is_sdr(head: bytes) -> bool:
    """Whether the file is certainly Sokkia SDR."""
    return _SDR.match(head) is not None


def is_dc(head: bytes) -> bool:
    """Whether the file is certainly a Trimble DC file."""
    return _DC.match(head) is not None


def is_jobxml(head: bytes) -> bool:
    """Whether the file is certainly Trimble JobXML."""
    start = head.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
    return start == b"<" and _JOBXML.search(head[:4096]) is not None


def _make(name: str, description: str, suffix: str, sniff: Callable[[bytes], bool]) -> Format:
    """Describe a format of an instrument."""
    read = f"{__package__}.instruments.{name}:read"
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
