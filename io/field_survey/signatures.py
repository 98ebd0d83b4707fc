"""What the first bytes of a file of an instrument say."""

from __future__ import annotations

import re

__all__ = ["is_dc", "is_gsi", "is_jobxml", "is_sdr"]

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
