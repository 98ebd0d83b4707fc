"""The header of a LAS or LAZ file, proven against the size of the file before anything is read.

References
----------
ASPRS, LAS Specification 1.4 - R15 (2019). M. Isenburg, LASzip (2013). COPC Specification 1.0
(https://copc.io).
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.errors import ReadError
from ...base.notes import naming_file
from ...base.sentences import FILE, coordinate, counted, inflect
from ..isolated import translate_system_errors

if TYPE_CHECKING:
    from pathlib import Path

_FIXED = struct.Struct("<4sHH16sBB32s32sHHHIIBHI20s12d")
_HEADER_BYTES = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}
"""Bytes of the header by the minor version."""

_POINT_BYTES = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)
"""Bytes of a point record by its format, without extra ones."""

_VERSION_OF_FORMAT = (0, 0, 2, 2, 3, 3, 4, 4, 4, 4, 4)
"""The first minor version that has a format of points."""

_RECORD = struct.Struct("<H16sHH32s")
_EXTENDED_RECORD = struct.Struct("<H16sHQ32s")
_COMPRESSED_BITS = 0b1100_0000
_LARGEST_RECORD = 1 << 24
"""Bytes of a variable record that are read; those that describe a CRS have some thousand."""

_LASZIP = ("laszip encoded", 22204)
_COPC = ("copc", 1)
_VARIABLE_CHUNKS = (0, 2**32 - 1)
"""Sizes that stand for none, as COPC has it: the table tells the points of each chunk."""

_LASTING = 2**31
"""Coordinates are stored as whole numbers of 32 bits."""


class Record(NamedTuple):
    """A variable-length record: whose, which, and its content."""

    user: str
    number: int
    content: bytes


@dataclass(frozen=True, slots=True)
class Header:
    """What a file says of itself."""

    path: Path
    size: int
    """Bytes of the file."""
    version: int
    """The minor one of LAS 1."""
    point_format: int
    point_bytes: int
    is_compressed: bool
    count: int
    """Of points."""
    offset: int
    """Where the points begin."""
    scales: np.ndarray[tuple[int], np.dtype[np.float64]]
    offsets: np.ndarray[tuple[int], np.dtype[np.float64]]
    """Both (3,): a coordinate is its whole number times the scale plus the offset."""
    low: np.ndarray[tuple[int], np.dtype[np.float64]]
    high: np.ndarray[tuple[int], np.dtype[np.float64]]
    """Both (3,), the bounds that it gives, which no coordinate has to keep to."""
    records: tuple[Record, ...]
    surplus: int
    """Bytes behind the points of a file that is not compressed, which no record explains."""

    @property
    def is_copc(self) -> bool:
        """Whether the points are in an octree of levels."""
        return bool(self.records) and self.records[0][:2] == _COPC

    @property
    def records_format(self) -> str:
        """Version, and format of the points."""
        return f"LAS 1.{self.version}, point format {self.point_format}"

    @property
    def middle(self) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """Middle of the bounds."""
        with np.errstate(over="ignore", invalid="ignore"):
            return np.nan_to_num(self.low / 2 + self.high / 2)

    def find(self, user: str, number: int) -> bytes | None:
        """Return the content of the first record of a kind; None if there is none."""
        found = (one.content for one in self.records if (one.user, one.number) == (user, number))
        return next(found, None)


def parse_header(path: Path) -> Header:
    """Read the header and the variable-length records of a file.

    Raises
    ------
    ReadError
        If it is no LAS file of a version that is read, or says what cannot be: more points or
        records than the file has bytes for, a scale of 0, an unknown format of points.
    """
    with naming_file(path), translate_system_errors(path), path.open("rb") as file:
        return _parse(file, path, path.stat().st_size)


def _parse(file: IO[bytes], path: Path, size: int) -> Header:
    fixed = file.read(_FIXED.size)
    if not fixed.startswith(b"LASF") or len(fixed) < _FIXED.size:
        raise _describe_fault("it has no whole header of LAS")
    fields = _FIXED.unpack(fixed)
    major, version, header_bytes, offset, n_records = *fields[4:6], *fields[10:13]
    _require_version(major, version, header_bytes)
    _require_offset(header_bytes, offset, size)
    file.seek(0)
    whole = file.read(header_bytes)
    point_format, point_bytes = _require_point_format(fields[13], fields[14], version)
    is_compressed = bool(fields[13] & _COMPRESSED_BITS)
    count = _find_count(whole, version, fields[15])
    scales, offsets = _require_scales(fields[17:])
    records = _read_records(file, _RECORD, header_bytes, offset, n_records)
    further, first_further = _read_extended_records(file, whole, version, size)
    header = Header(
        path=path,
        size=size,
        version=version,
        point_format=point_format,
        point_bytes=point_bytes,
        is_compressed=is_compressed,
        count=count,
        offset=offset,
        scales=scales,
        offsets=offsets,
        low=np.array(fields[24::2]),
        high=np.array(fields[23::2]),
        records=(*records, *further),
        surplus=_find_surplus(whole, version, offset + count * point_bytes, first_further or size),
    )
    _require_room(header, file)
    return header


def _describe_fault(what: str) -> ReadError:
    return ReadError(f"{FILE} is damaged or cut short: {what}.")


def _require_version(major: int, version: int, header_bytes: int) -> None:
    if major != 1 or version not in _HEADER_BYTES:
        raise ReadError(f"{FILE} is LAS {major}.{version}: the versions 1.0 to 1.4 can be read.")
    if header_bytes < _HEADER_BYTES[version]:
        raise _describe_fault(
            f"its header is said to have {header_bytes} bytes, and that of LAS 1.{version} has "
            f"{_HEADER_BYTES[version]}"
        )


def _require_offset(header_bytes: int, offset: int, size: int) -> None:
    if not header_bytes <= offset <= size:
        raise _describe_fault(
            f"its points are said to begin at byte {offset:,}, and the header ends at byte "
            f"{header_bytes:,}, the file at byte {size:,}"
        )


def _require_point_format(number: int, point_bytes: int, version: int) -> tuple[int, int]:
    plain = number & ~_COMPRESSED_BITS
    if plain >= len(_POINT_BYTES):
        raise ReadError(
            f"{FILE} has points of the format {plain}: 0 to {len(_POINT_BYTES) - 1} can be read."
        )
    if _VERSION_OF_FORMAT[plain] > version:
        raise _describe_fault(
            f"it is LAS 1.{version} with points of the format {plain}, which LAS "
            f"1.{_VERSION_OF_FORMAT[plain]} brought"
        )
    if point_bytes < _POINT_BYTES[plain]:
        raise _describe_fault(
            f"a point is said to have {point_bytes} bytes, and one of the format {plain} has "
            f"{_POINT_BYTES[plain]}"
        )
    return plain, point_bytes


def _find_count(whole: bytes, version: int, legacy: int) -> int:
    """Return the number of points; LAS 1.4 gives it twice, unless it needs more than 32 bits."""
    if version < 4:
        return legacy
    (count,) = struct.unpack_from("<Q", whole, 247)
    if legacy not in (0, count):
        said = counted(count, "point")
        raise _describe_fault(f"it is said to have {said}, and in another place {legacy:,}")
    return int(count)


def _require_scales(
    numbers: tuple[float, ...],
) -> tuple[
    np.ndarray[tuple[int], np.dtype[np.float64]], np.ndarray[tuple[int], np.dtype[np.float64]]
]:
    scales, offsets = np.array(numbers[:3]), np.array(numbers[3:6])
    with np.errstate(over="ignore", invalid="ignore"):
        reach = np.abs(scales) * _LASTING + np.abs(offsets)
    if not np.isfinite(reach).all() or (scales == 0).any():
        raise _describe_fault(
            f"its coordinates have the scales {_list(scales)} and the offsets {_list(offsets)}, "
            "and finite ones, the scales not 0, are needed"
        )
    return scales, offsets


def _list(numbers: np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    return ", ".join(coordinate(one) for one in numbers.tolist())


# ------------------------------------------------------------------- variable records


def _read_records(
    file: IO[bytes], form: struct.Struct, start: int, end: int, count: int
) -> list[Record]:
    """Read records that lie between two bytes of the file, one after the other."""
    if count * form.size > end - start:
        raise _describe_fault(
            inflect(
                f"{counted(count, 'variable-length record')} [is|are] said to lie in "
                f"{counted(max(0, end - start), 'byte')}",
                count,
            )
        )
    records = []
    place = start
    for number in range(count):
        file.seek(place)
        head = file.read(form.size)
        length = form.unpack(head)[3] if len(head) == form.size else end
        if place + form.size + length > end:
            raise _describe_fault(f"variable-length record {number} reaches beyond its end")
        _, user, kind, _, _ = form.unpack(head)
        if length <= _LARGEST_RECORD:
            records.append(Record(_read_text(user), kind, file.read(length)))
        place += form.size + length
    return records


def _read_text(content: bytes) -> str:
    return content.split(b"\0")[0].decode("ascii", "replace").strip()


def _read_extended_records(
    file: IO[bytes], whole: bytes, version: int, size: int
) -> tuple[list[Record], int]:
    """Return the records behind the points, and where they begin; 0 without any."""
    if version < 4:
        return [], 0
    start, count = struct.unpack_from("<QI", whole, 235)
    if count == 0:
        return [], 0
    if start >= size:
        raise _describe_fault(
            f"its extended records are said to begin at byte {start:,}, and the file ends at byte "
            f"{size:,}"
        )
    return _read_records(file, _EXTENDED_RECORD, start, size, count), start


def _find_surplus(whole: bytes, version: int, end: int, until: int) -> int:
    """Return the bytes behind the points that neither records nor waveforms explain."""
    has_waveforms = version >= 3 and struct.unpack_from("<Q", whole, 227)[0] > 0
    return 0 if has_waveforms else max(0, until - end)


# --------------------------------------------------------------------- room for points


def _require_room(header: Header, file: IO[bytes]) -> None:
    """Refuse more points than the file has bytes for."""
    room = header.size - header.offset
    if header.is_compressed:
        _require_chunks(header, file)
    elif header.count * header.point_bytes > room:
        raise _describe_fault(
            inflect(
                f"{counted(header.count, 'point')} of {header.point_bytes} bytes [is|are] said to "
                f"be in {counted(room, 'byte')}",
                header.count,
            )
        )


def _require_chunks(header: Header, file: IO[bytes]) -> None:
    """Compare the number of points with the chunks that the compressor tells of."""
    laszip = header.find(*_LASZIP)
    if laszip is None or len(laszip) < 34:
        raise _describe_fault("it is compressed, and does not say how")
    compressor, _, _, _, _, _, chunk_size = struct.unpack_from("<HHBBHII", laszip)
    if compressor not in (2, 3) or header.count == 0:
        return  # no chunks; the size of all points is looked at where they are counted
    n_chunks = _count_chunks(header, file)
    if n_chunks is None or chunk_size in _VARIABLE_CHUNKS:
        return
    if not (n_chunks - 1) * chunk_size < header.count <= n_chunks * chunk_size:
        raise _describe_fault(
            inflect(
                f"{counted(header.count, 'point')} [is|are] said to be in "
                f"{counted(n_chunks, 'chunk')} of {chunk_size:,}",
                header.count,
            )
        )


def _count_chunks(header: Header, file: IO[bytes]) -> int | None:
    """Return how many chunks the table of a compressed file tells of; None if it has no table."""
    file.seek(header.offset)
    (table,) = struct.unpack("<q", file.read(8).ljust(8, b"\0"))
    if table == -1:  # the writer could not go back: it stands at the end
        file.seek(max(header.offset, header.size - 8))
        (table,) = struct.unpack("<q", file.read(8).ljust(8, b"\0"))
    if not header.offset + 8 <= table <= header.size - 8:
        raise _describe_fault(
            f"the table of its chunks is said to be at byte {table:,} of {header.size:,}"
        )
    file.seek(table)
    _, n_chunks = struct.unpack("<II", file.read(8))
    if n_chunks * header.point_bytes > header.size:  # each begins with a whole point
        raise _describe_fault(f"{n_chunks:,} chunks are said to be in {header.size:,} bytes")
    return int(n_chunks)
