"""Features of a vector file through pyogrio, as the child process reads them."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ...base.sentences import FILE
from ..isolated import REFERRING_DRIVERS, VECTOR_DRIVERS, Answer, Refusal, make_environment

ENVIRONMENT = make_environment()

_WESTERN = "CP1252"

_ANY_KIND, _SURFACES = 0, (15, 16, 17)
_ANY_WITH_Z = 2**31
"""Numbers of kinds of geometry, as GDAL has them."""

_UNDEFINED_CARTESIAN = re.compile(r'(LOCAL_CS|ENGCRS|ENGINEERINGCRS)\["Undefined Cartesian SRS"')
_GDAL_SOURCE = re.compile(r"^\S+\.cpp, \d+: ")


def prepare() -> None:
    """Load the library, and switch every driver off that is not allowed."""
    import pyogrio
    from pyogrio import _ogr

    unwanted = pyogrio.list_drivers().keys() - set(VECTOR_DRIVERS)
    pyogrio.set_gdal_config_options(
        {"GDAL_SKIP": ",".join(sorted(unwanted | set(REFERRING_DRIVERS)))}
    )
    if hasattr(_ogr, "_register_drivers"):
        _ogr._register_drivers()
    loaded = pyogrio.list_drivers().keys() & set(REFERRING_DRIVERS)
    if loaded:
        raise RuntimeError(f"the GDAL driver {min(loaded)} cannot be switched off")
    _name_further_kinds()


def _name_further_kinds() -> None:
    """Let pyogrio take layers of kinds that it has no name for, and refuses.

    They are those of any geometry with elevations or measures, and surfaces: TIN, triangle and
    polyhedral surface. It only looks the name up.
    """
    from pyogrio import _geometry

    names = getattr(_geometry, "GEOMETRY_TYPES", {})
    for kind in (_ANY_KIND, *_SURFACES):
        for dimension in (0, 1000, 2000, 3000):
            names.setdefault(kind + dimension, "Unknown")
    for number in (_ANY_WITH_Z, _ANY_WITH_Z - 2**32):  # the one of no dimension that has a flag
        names.setdefault(number, "Unknown")


def read_features(path: str, *, layer: str | None, where: str | None) -> Answer:
    """Return the features of one layer.

    The value holds ``layer``, ``crs``, ``elevation_unit`` if the layer tells it, ``names`` of the
    columns, ``texts``, the columns that are no numbers, by their place, and ``notes``. The arrays
    hold ``numbers`` of the features, ``wkb`` of all geometries, ``lengths`` of each (-1 where there
    is none), and ``column 0`` ...
    """
    import pyogrio
    from pyogrio.errors import DataSourceError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            chosen = _choose_layer(path, layer)
            (meta, numbers, geometries, values), notes = _read_texts_right(
                path, layer=chosen, where=where, return_fids=True
            )
            metadata = pyogrio.read_info(path, layer=chosen)["layer_metadata"] or {}
    except (RuntimeError, ValueError, IndexError) as error:
        if isinstance(error, DataSourceError) and "not recognized" in str(error):
            raise Refusal(f"{FILE} is no vector file that GDAL knows.") from error
        text = " ".join(str(error).split("; ")[-1].split())
        raise RuntimeError(
            _GDAL_SOURCE.sub("", text).rstrip(".") or type(error).__name__
        ) from error
    arrays = {"numbers": np.asarray(numbers, np.int64), **pack_geometries(geometries)}
    arrays |= {f"column {k}": column for k, column in enumerate(values) if is_numeric(column)}
    texts = {
        str(k): convert_to_texts(column)
        for k, column in enumerate(values)
        if not is_numeric(column)
    }
    names = [str(name) for name in meta["fields"]]
    # Return the CRS of a layer; None for what GDAL makes of "undefined" in a GeoPackage. It
    # gives the undefined Cartesian CRS (srs_id -1) the unit metre, of which the file says
    # nothing.
    crs = meta["crs"]
    crs = None if crs is not None and _UNDEFINED_CARTESIAN.match(crs) else crs
    notes += _describe_missing_crs(path, crs)
    value = {"layer": chosen, "crs": crs, "names": names, "texts": texts, "notes": notes}
    return Answer(value | {"elevation_unit": metadata.get("elevation_unit")}, arrays)


def _read_texts_right(path: str, **how: Any) -> tuple[Any, list[str]]:
    """Read a layer; texts of a shapefile that are in another encoding than it says, as they are.

    Bytes of another encoding are hardly ever UTF-8 by chance, so texts of which all are, are it.
    """
    from pyogrio import raw

    try:
        read = raw.read(path, **how)
    except UnicodeDecodeError:
        note = f"'{Path(path).name}': texts are no UTF-8, which they are said to be: taken to be "
        return raw.read(path, encoding=_WESTERN, **how), [f"{note}Windows-1252."]
    if not path.lower().endswith(".shp"):
        return read, []
    texts = [
        one
        for column in read[3]
        if not is_numeric(column)
        for one in column.tolist()
        if isinstance(one, str) and not one.isascii()
    ]
    if not texts or not all(map(_is_misread, texts)):
        return read, []
    note = f"'{Path(path).name}': texts are UTF-8, though the file does not say so."
    return raw.read(path, encoding="UTF-8", **how), [note]


def _is_misread(text: str) -> bool:
    """Whether the bytes of a text that was read as Latin-1 are UTF-8."""
    try:
        text.encode("latin-1").decode("utf-8")
    except UnicodeError:
        return False
    return True


def _describe_missing_crs(path: str, crs: str | None) -> list[str]:
    if crs is not None or not path.lower().endswith(".shp"):
        return []
    for suffix in (".prj", ".PRJ"):
        file = Path(path).with_suffix(suffix)
        if file.is_file() and file.stat().st_size:
            name = Path(path).name.rpartition(".")[0] + suffix
            return [f"'{name}' names a CRS that is not understood: it was left aside."]
    return []


def _choose_layer(path: str, layer: str | None) -> str:
    import pyogrio

    layers = [str(name) for name, kind in pyogrio.list_layers(path) if kind is not None]
    if not layers:
        raise Refusal(f"{FILE} has no layer with geometry, or is damaged.")
    if layer is None and len(layers) > 1:
        raise Refusal(
            f"{FILE} has {len(layers)} layers: name one of {', '.join(layers)} "
            f"(`layer={layers[0]!r}`, or of a file of lines '{Path(path).name}:{layers[0]}')."
        )
    if layer is not None and layer not in layers:
        raise Refusal(f"{FILE} has no layer '{layer}' with geometry: there is {', '.join(layers)}.")
    return layers[0] if layer is None else layer


def pack_geometries(geometries: Any) -> dict[str, Any]:
    """Return well-known binary one after the other, and the length of each, -1 for none."""
    lengths = [-1 if one is None else len(one) for one in geometries]
    wkb = b"".join(one for one in geometries if one is not None)
    return {
        "wkb": np.frombuffer(wkb, np.uint8),
        "lengths": np.array(lengths, np.int64),
    }


def is_numeric(column: Any) -> bool:
    """Whether a column holds numbers or truth values."""
    return np.asarray(column).dtype.kind in "biuf"


def convert_to_texts(column: Any) -> list[str | None]:
    """Return values as text: dates, lists and bytes have no other use here."""
    return [None if value is None or value != value else str(value) for value in column.tolist()]
