"""Virtual rasters (VRT): a text that names other rasters, read only if those are plain files.

GDAL would follow any reference: to the network, to pipelines, to any file of the machine. So a VRT
is read under its own suffix alone, with the elements of a mosaic alone, and what it names must be
plain rasters in its own folder or below.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...base.errors import ReadError
from ...base.sentences import FILE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from xml.etree import ElementTree as ET

SUFFIX = ".vrt"

LARGEST_TEXT = 1 << 26
"""Bytes of a VRT: 100,000 sources take 50 MB."""

_MOSAIC = frozenset(
    {
        *("VRTDataset", "SRS", "GeoTransform", "Metadata", "MDI", "BlockXSize", "BlockYSize"),
        *("VRTRasterBand", "ColorInterp", "NoDataValue", "HideNoDataValue", "Scale", "Offset"),
        *("UnitType", "Description", "CategoryNames", "Category", "ColorTable", "Entry"),
        *("SimpleSource", "ComplexSource", "AveragedSource", "NoDataFromMaskSource"),
        *("SourceFilename", "SourceBand", "SourceProperties", "SrcRect", "DstRect", "NODATA"),
        *("ScaleOffset", "ScaleRatio", "LUT", "UseMaskBand", "MaskBand", "RemapValues"),
        *("Histograms", "HistItem", "HistMin", "HistMax", "BucketCount", "IncludeOutOfRange"),
        *("Approximate", "HistCounts", "OverviewList", "Exponent", "SrcMin", "SrcMax", "DstMin"),
        *("DstMax", "ColorTableComponent", "MaskValueThreshold"),
    }
)
"""Elements of a mosaic. Not among them: warped and derived rasters, raw bands, overviews."""

_CLASSES = frozenset({None, "VRTSourcedRasterBand"})
_BESIDE = (".aux.xml", ".ovr", ".msk")
_REFERENCES = (b"OVERVIEW_FILE", b"SourceFilename", b"SourceDataset", b"/vsi")
_HEAD = 1 << 16


def is_virtual(path: Path) -> bool:
    """Whether a path has the suffix of a VRT."""
    return path.suffix.lower() == SUFFIX


def require_plain_sources(path: Path) -> list[Path]:
    """Return the rasters that a VRT is made of.

    Raises
    ------
    ReadError
        If the file is no VRT of a plain mosaic, or names something else than plain files in its
        folder or below.
    """
    root = _parse_text(path)
    for element in root.iter():
        if element.tag not in _MOSAIC:
            raise _describe_refused_mosaic(f"has the element '{str(element.tag)[:60]}'")
        if element.get("subClass") not in _CLASSES:
            raise _describe_refused_mosaic(f"is of the class '{str(element.get('subClass'))[:60]}'")
        if element.tag == "MDI" and element.get("key") == "OVERVIEW_FILE":
            raise _describe_refused_mosaic("names a file of overviews")
    names = [
        (one.text or "", one.get("relativeToVRT") == "1") for one in root.iter("SourceFilename")
    ]
    sources = [_find_source(name, relative, path) for name, relative in dict.fromkeys(names)]
    for file in [path, *sources]:
        # Refuse files beside a raster (overviews, masks, metadata) that name other files.
        for beside in _find_files_beside(file):
            head = _read_start(beside)
            is_text = beside.suffix != ".xml" and head.lstrip().startswith(b"<")
            if is_text or any(reference in head for reference in _REFERENCES):
                raise _describe_refused_mosaic(
                    f"has the file '{beside.name}' beside it, which names other files"
                )
    return sources


def _parse_text(path: Path) -> ET.Element:
    from xml.etree import ElementTree as ET

    try:
        size = path.stat().st_size
        content = b"" if size > LARGEST_TEXT else path.read_bytes()
    except OSError as error:
        raise ReadError(f"Cannot read {FILE}: {error.strerror or error}.") from error
    if size > LARGEST_TEXT:
        raise _describe_refused_mosaic(f"is larger than {LARGEST_TEXT:,} bytes")
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        raise _describe_refused_mosaic("declares entities")
    try:
        root = ET.fromstring(content)
    except (ET.ParseError, ValueError, LookupError) as error:
        raise ReadError(
            f"{FILE} is no virtual raster, or a damaged one: {str(error).rstrip('.')}."
        ) from error
    if root.tag != "VRTDataset":
        raise ReadError(f"{FILE} is no virtual raster: it is a '{root.tag[:60]}'.")
    return root


def _find_source(name: str, is_relative: bool, path: Path) -> Path:
    """Return the file that a source names."""
    folder = path.absolute().parent
    try:
        file = (folder if is_relative else Path.cwd()) / name
        inside = file.resolve().is_relative_to(folder.resolve())
        is_file = inside and file.is_file()
    except (OSError, ValueError):
        raise _describe_refused_mosaic(f"names '{name[:200]}', no path of a file") from None
    if not inside:
        raise _describe_refused_mosaic(f"names '{name[:200]}', which is not in its folder or below")
    if not is_file:
        raise ReadError(f"{FILE} is made of '{name[:200]}', and there is no such file.")
    if is_virtual(file) or _read_start(file).lstrip().startswith((b"<", b"{", b"\xef\xbb\xbf<")):
        raise _describe_refused_mosaic(
            f"names '{name[:200]}', which is itself a text of references"
        )
    return file


def _find_files_beside(file: Path) -> Iterator[Path]:
    for ending in _BESIDE:
        for beside in (Path(f"{file}{ending}"), file.with_suffix(ending)):
            if beside.is_file():
                yield beside


def _read_start(file: Path) -> bytes:
    with file.open("rb") as opened:
        return opened.read(_HEAD)


def _describe_refused_mosaic(what: str) -> ReadError:
    return ReadError(
        f"{FILE} {what}: a virtual raster is read if it is a mosaic of plain rasters in its own "
        "folder or below; make a GeoTIFF of any other.",
    )
