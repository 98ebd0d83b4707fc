"""What the first bytes of a file say: whether it is a drawing."""

from __future__ import annotations

import re

BINARY_DXF = b"AutoCAD Binary DXF\r\n\x1a\x00"
"""How a binary DXF begins."""

_MARKS = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be", b"\xef\xbb\xbf": "utf-8"}
_BEFORE_ROOT = re.compile(
    r"(?:\s+|<\?.{0,2000}?\?>|<!--.*?-->|<!DOCTYPE[^\[>]*(?:\[.*?\]\s*)?>)*", re.S
)
_ROOT = re.compile(r"<(?:[\w.-]+:)?LandXML[\s/>]")
_ARCHIVE = re.compile(
    r"(?:\s+|//[^\n]*\n)*(?:model|colour|style|breakline|null|attributes|project_attributes|string|"
    r"tin|full_tin|super_tin|primitive_3d)\s",
    re.I,
)
_ELEMENT = re.compile(r"^(?:[^\n\"]*\s)?(?:string\s+\w+|tin|full_tin)\s*\{", re.I | re.M)
_DXF = re.compile(
    rb"(?:\s*999\r?\n[^\n]*\n)*\s*0[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n[ \t]*2[ \t]*\r?\n"
)


def is_landxml(head: bytes) -> bool:
    """Whether the file is LandXML, of whatever version and encoding.

    Examples
    --------
    >>> is_landxml(b'<?xml version="1.0"?><LandXML version="1.2">')
    True
    """
    encoding = next((name for mark, name in _MARKS.items() if head.startswith(mark)), "latin-1")
    text = head.decode(encoding, errors="replace").lstrip("\ufeff")
    before = _BEFORE_ROOT.match(text)
    return before is not None and _ROOT.match(text, before.end()) is not None


def is_12da(head: bytes) -> bool:
    r"""Whether the file is an archive of 12d Model: its first word, and a string or a tin.

    Examples
    --------
    >>> is_12da(b'model "site"\nstring super {\n')
    True
    """
    encoding = next((name for mark, name in _MARKS.items() if head.startswith(mark)), "latin-1")
    text = head.decode(encoding, errors="replace").lstrip("\ufeff")
    return _ARCHIVE.match(text) is not None and _ELEMENT.search(text) is not None


def is_dxf(head: bytes) -> bool:
    r"""Whether the file is a DXF drawing, text or binary.

    Examples
    --------
    >>> is_dxf(b"  0\nSECTION\n  2\nHEADER\n")
    True
    """
    text = head.removeprefix(b"\xef\xbb\xbf")
    return head.startswith(BINARY_DXF) or _DXF.match(text) is not None
