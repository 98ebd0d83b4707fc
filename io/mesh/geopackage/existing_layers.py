"""GeoPackages that exist: layers are put into a file whose other layers stay as they are."""

from __future__ import annotations

import json
import re
import shutil
import sqlite3
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ....base.atomic import folder_beside, replacing_path
from ....base.errors import WriteError
from ....base.sentences import FILE
from .schema import LAYERS, NO_CLOCK, NUMBERS, RECORD, digest_lines
from .styles import STYLES, has_foreign_styles, merge_styles

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

MARK = "written by"
"""Item of a layer's metadata whose value is ``tinsmith``."""

_MARKED = f'%<MDI key="{MARK}">tinsmith</MDI>%'
_OF_TIN = (*LAYERS, NUMBERS, RECORD)
_SYSTEM = re.compile(r"(gpkg|rtree|sqlite)_", re.IGNORECASE)
"""What names of tables that are no content begin with."""
_SRS_AT = slice(4, 8)
"""Where the header of a geometry has the number of its CRS."""


class Placing(NamedTuple):
    """What becomes of a layer that has the same name in the file already."""

    overwrite: bool = False
    """Replace it, whoever wrote it."""
    append: bool = False
    """Add to its features, if tinsmith wrote it."""


@contextmanager
def adding_layers(path: Path, placing: Placing) -> Iterator[Path]:
    """Yield the path of a new GeoPackage, whose layers are then put into that at ``path``.

    Parameters
    ----------
    path : Path
        If there is no file, or it has no other layers, the new one takes its place.
    placing : Placing
    """
    require_closed(path)
    with replacing_path(path) as beside:
        if not path.exists() or path.stat().st_size == 0:
            yield beside
            return
        with folder_beside(beside.with_name(path.name)) as folder:
            made = Path(folder, path.name)
            yield made
            try:
                with closing(_open(path)) as old, closing(sqlite3.connect(made)) as new:
                    layers = _list_layers(new)
                    replaced = [*layers, *_list_rest_of_tin(old, layers)]
                    _require_free(old, replaced, placing, path)
                    others = _list_tables(old) - {*replaced, STYLES}
                    is_all = not placing.append and not others and not has_foreign_styles(old)
                if is_all:
                    shutil.copyfile(made, beside)
                else:
                    _merge(path, made, beside, placing)
            except sqlite3.Error as error:
                raise WriteError(f"Cannot write {FILE}: {error}.") from error


def _open(path: Path) -> sqlite3.Connection:
    file = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)
    try:
        file.execute("SELECT count(*) FROM gpkg_contents").fetchone()
    except sqlite3.DatabaseError as error:
        file.close()
        why = "it is locked by another program" if "locked" in str(error) else "it is no GeoPackage"
        raise WriteError(
            f"Cannot write {FILE}: a file is there, and {why}; name another file."
        ) from error
    return file


def _list_layers(file: sqlite3.Connection, schema: str = "main") -> list[str]:
    """Return the names of the layers, and of the table that a view is made of; styles are none."""
    found = file.execute(
        f"SELECT table_name FROM {schema}.gpkg_contents UNION ALL "
        f"SELECT name FROM {schema}.sqlite_master WHERE name = '{NUMBERS}'"
    )
    return [name for (name,) in found if name != STYLES]


def _list_tables(file: sqlite3.Connection) -> set[str]:
    found = file.execute("SELECT name FROM sqlite_master WHERE type IN ('table', 'view')")
    return {name for (name,) in found if not _SYSTEM.match(name)}


def _list_rest_of_tin(old: sqlite3.Connection, layers: Sequence[str]) -> list[str]:
    """Return what is there of a TIN beside layers of its names, if these are those of another."""
    there = _list_tables(old)
    both = RECORD in there and RECORD in layers
    return [name for name in _OF_TIN if both and name in there and name not in layers]


# ------------------------------------------------------------------- what may be replaced


def _require_free(
    old: sqlite3.Connection, layers: Sequence[str], placing: Placing, path: Path
) -> None:
    there = {name.casefold(): name for name in _list_tables(old)}
    is_tin = RECORD in layers
    for name in layers:
        found = there.get(name.casefold())
        if found is None:
            continue
        if not is_tin and RECORD in there and found in _OF_TIN:
            raise _refuse(path, found, "is part of the TIN there")
        if placing.overwrite:
            continue
        if not _is_ours(old, found):
            raise _refuse(path, found, "was not written by tinsmith")
        row = _ask(
            old, "SELECT last_change FROM gpkg_contents WHERE lower(table_name) = lower(?)", found
        )
        if row is not None and row[0] != NO_CLOCK:
            raise _refuse(path, found, "was changed by another program since tinsmith wrote it")


def _refuse(path: Path, layer: str, why: str) -> WriteError:
    return WriteError(
        f"Cannot write {FILE}: its layer '{layer}' {why}. Name another layer "
        f"('{path.name}:NAME'), or overwrite it on purpose."
    )


def _is_ours(file: sqlite3.Connection, layer: str) -> bool:
    if layer in _OF_TIN:
        return RECORD in _list_tables(file)
    if not _has_table_in(file, "main", "gpkg_metadata_reference"):
        return False
    found = _ask(
        file,
        "SELECT 1 FROM gpkg_metadata JOIN gpkg_metadata_reference ON id = md_file_id "
        "WHERE lower(table_name) = lower(?) AND metadata LIKE ?",
        *(layer, _MARKED),
    )
    return found is not None


# ------------------------------------------------------------------- putting layers in


def _merge(path: Path, made: Path, beside: Path, placing: Placing) -> None:
    """Copy a GeoPackage, and put the layers of a new one into the copy."""
    with closing(sqlite3.connect(beside, isolation_level=None)) as file:
        with closing(_open(path)) as old:
            old.backup(file)
        file.execute("PRAGMA journal_mode = DELETE")
        file.execute("ATTACH ? AS made", (str(made),))
        file.execute("PRAGMA foreign_keys = OFF")
        file.execute("BEGIN")
        numbers = _add_references(file)
        layers = _list_layers(file, "made")
        if RECORD in layers:
            layers = [*(name for name in layers if name != RECORD), RECORD]
        for rest in _list_rest_of_tin(file, layers):
            _remove(file, rest)
        for layer in layers:
            there = _ask(
                file,
                "SELECT name FROM main.sqlite_master WHERE type IN ('table', 'view') "
                "AND lower(name) = lower(?)",
                layer,
            )
            if there is not None and placing.append:
                _append(file, layer, there[0], numbers)
                continue
            if there is not None:
                _remove(file, there[0])
            _add(file, layer, numbers)
        if RECORD in layers:
            _renew_digest(file)
        merge_styles(file)
        file.execute("COMMIT")
        file.execute("DETACH made")


def _renew_digest(file: sqlite3.Connection) -> None:
    """Let the record of a TIN tell of its lines as they are, whose CRS may have another number."""
    (text,) = _ask(file, f"SELECT data FROM main.{RECORD} WHERE name = 'digests'")
    rows = file.execute("SELECT geom, kind, name FROM main.lines ORDER BY fid")
    digests = json.loads(text) | {"lines": digest_lines(rows)}
    file.execute(
        f"UPDATE main.{RECORD} SET data = ? WHERE name = 'digests'", (json.dumps(digests).encode(),)
    )


def _add_references(file: sqlite3.Connection) -> dict[int, int]:
    """Add the CRS that the file lacks; return its number of each CRS of the new file."""
    numbers = {}
    for values in _list_rows(file, "gpkg_spatial_ref_sys"):
        number = int(values["srs_id"])
        numbers[number] = _find_reference(file, values)
        if numbers[number] is None:
            taken = {srs for (srs,) in file.execute("SELECT srs_id FROM main.gpkg_spatial_ref_sys")}
            numbers[number] = values["srs_id"] = (
                number if number not in taken else max(*taken, 100_000) + 1
            )
            _insert(file, "gpkg_spatial_ref_sys", values)
    return numbers


def _find_reference(file: sqlite3.Connection, values: dict[str, Any]) -> Any:
    """Return the number of the same CRS in the file: of the same code, or the same words."""
    code: tuple[Any, ...] = (values["organization"], values["organization_coordsys_id"])
    same = "lower(organization) = lower(?) AND organization_coordsys_id = ?"
    if str(code[0]).upper() == "NONE" and values["srs_id"] not in (0, -1):
        code, same = (values["definition"],), "definition = ? AND definition <> 'undefined'"
    row = _ask(file, f"SELECT srs_id FROM main.gpkg_spatial_ref_sys WHERE {same}", *code)
    return None if row is None else row[0]


def _add(file: sqlite3.Connection, layer: str, numbers: dict[int, int]) -> None:
    """Copy a layer with its rows, index and registration."""
    name = _quote(layer)
    own = file.execute(
        "SELECT type, name, sql FROM made.sqlite_master WHERE lower(tbl_name) IN "
        "(lower(?), lower('rtree_' || ? || '_' || coalesce((SELECT column_name FROM "
        "made.gpkg_geometry_columns WHERE table_name = ?), ''))) AND sql IS NOT NULL",
        (layer, layer, layer),
    ).fetchall()
    ((declared, kind),) = [
        (sql, kind) for kind, table, sql in own if kind in ("table", "view") and table == layer
    ]
    indexed = [(table, sql) for kind, table, sql in own if "USING rtree" in sql and kind == "table"]
    file.execute(declared)
    geometry = _ask(
        file, "SELECT column_name FROM made.gpkg_geometry_columns WHERE table_name = ?", layer
    )
    if kind == "table":
        file.execute(f"INSERT INTO main.{name} SELECT * FROM made.{name}")
    if kind == "table" and geometry is not None:
        _renumber(file, name, _quote(geometry[0]), numbers)
    for table, sql in indexed:
        file.execute(sql)
        index = _quote(table)
        file.execute(f"INSERT INTO main.{index} SELECT * FROM made.{index}")
    _register(file, layer, numbers)
    for kind, _, sql in own:
        if kind in ("trigger", "index"):
            file.execute(sql)


def _renumber(file: sqlite3.Connection, table: str, column: str, numbers: dict[int, int]) -> None:
    """Give geometries the number that their CRS has in this file."""
    changed = {old: new for old, new in numbers.items() if old != new}
    if not changed:
        return
    file.create_function("renumber", 1, lambda blob: _renumber_blob(blob, changed))
    file.execute(f"UPDATE main.{table} SET {column} = renumber({column})")


def _renumber_blob(blob: bytes | None, changed: dict[int, int]) -> bytes | None:
    if blob is None or len(blob) < _SRS_AT.stop:
        return blob
    order = "little" if blob[3] & 1 else "big"
    number = int.from_bytes(blob[_SRS_AT], order, signed=True)  # type: ignore[arg-type]
    mine = changed.get(number, number).to_bytes(4, order, signed=True)  # type: ignore[arg-type]
    return blob[: _SRS_AT.start] + mine + blob[_SRS_AT.stop :]


_REGISTERS = ("gpkg_contents", "gpkg_geometry_columns", "gpkg_extensions", "gpkg_ogr_contents")

_OF_TILES = ("gpkg_tile_matrix", "gpkg_tile_matrix_set")


def _register(file: sqlite3.Connection, layer: str, numbers: dict[int, int]) -> None:
    """Copy the rows that tell of a layer, with its metadata."""
    for register in _REGISTERS:
        if not _has_table_in(file, "made", register):
            continue
        _make_register(file, register)
        for values in _list_rows(file, register, layer):
            if values.get("srs_id") is not None:
                values["srs_id"] = numbers.get(values["srs_id"], values["srs_id"])
            _insert(file, register, values)
    # Copy the extensions of the system tables that are there now.
    if _has_table_in(file, "made", "gpkg_extensions"):
        for row in file.execute(
            "SELECT * FROM made.gpkg_extensions WHERE table_name LIKE 'gpkg_%'"
        ).fetchall():
            known = _ask(
                file,
                "SELECT 1 FROM main.gpkg_extensions WHERE table_name = ? AND extension_name = ?",
                *(row[0], row[2]),
            )
            if known is None and row[0] != "gpkg_spatial_ref_sys":
                file.execute("INSERT INTO main.gpkg_extensions VALUES (?, ?, ?, ?, ?)", row)
    _copy_metadata(file, layer)


def _copy_metadata(file: sqlite3.Connection, layer: str) -> None:
    if not _has_table_in(file, "made", "gpkg_metadata_reference"):
        return
    for register in ("gpkg_metadata", "gpkg_metadata_reference"):
        _make_register(file, register)
    rows = file.execute(
        "SELECT m.id, md_scope, md_standard_uri, mime_type, metadata, reference_scope, table_name, "
        "column_name, row_id_value, timestamp FROM made.gpkg_metadata m JOIN "
        "made.gpkg_metadata_reference r ON m.id = r.md_file_id WHERE lower(table_name) = lower(?)",
        (layer,),
    ).fetchall()
    for _, *row in rows:
        number = file.execute(
            "INSERT INTO main.gpkg_metadata (md_scope, md_standard_uri, mime_type, metadata) "
            "VALUES (?, ?, ?, ?)",
            row[:4],
        ).lastrowid
        file.execute(
            "INSERT INTO main.gpkg_metadata_reference (reference_scope, table_name, column_name, "
            "row_id_value, timestamp, md_file_id) VALUES (?, ?, ?, ?, ?, ?)",
            [*row[4:], number],
        )


def _make_register(file: sqlite3.Connection, register: str) -> None:
    """Make a system table that only the new file has."""
    if _has_table_in(file, "main", register):
        return
    for (sql,) in file.execute(
        "SELECT sql FROM made.sqlite_master WHERE tbl_name = ? AND sql IS NOT NULL "
        "ORDER BY type = 'trigger'",
        (register,),
    ).fetchall():
        file.execute(sql)


def _append(file: sqlite3.Connection, layer: str, there: str, numbers: dict[int, int]) -> None:
    kinds = [
        _ask(
            file,
            f"SELECT geometry_type_name, z, srs_id, column_name FROM {schema}.gpkg_geometry_columns"
            " WHERE lower(table_name) = lower(?)",
            layer,
        )
        for schema in ("made", "main")
    ]
    columns = [_list_columns(file, "made", layer), _list_columns(file, "main", there)]
    new, old = kinds
    same = new is not None and old is not None and new[:2] == old[:2] and new[3] == old[3]
    if not same or numbers.get(new[2], new[2]) != old[2] or set(columns[0]) != set(columns[1]):
        raise WriteError(
            f"Cannot append to the layer '{there}' of {FILE}: geometries, columns and CRS must "
            f"be the same; it has {', '.join(columns[1])}."
        )
    listed = ", ".join(_quote(one) for one in columns[0] if one.casefold() != "fid")
    triggers = file.execute(
        "SELECT name, sql FROM main.sqlite_master WHERE type = 'trigger' AND tbl_name = ?", (there,)
    ).fetchall()
    for name, _ in triggers:  # they call functions that SQLite alone has not
        file.execute(f"DROP TRIGGER main.{_quote(name)}")
    (last,) = _ask(file, f"SELECT coalesce(max(rowid), 0) FROM main.{_quote(there)}")
    geometry = _quote(new[3])
    file.execute(
        f"INSERT INTO main.{_quote(there)} ({listed}) SELECT {listed} FROM made.{_quote(layer)} "
        "ORDER BY rowid"
    )
    _renumber(file, _quote(there), geometry, numbers)
    _append_to_index(file, layer, there, new[3], int(last))
    for _, sql in triggers:
        file.execute(sql)
    _update_counts(file, layer, there)


def _append_to_index(
    file: sqlite3.Connection, layer: str, there: str, geometry: str, last: int
) -> None:
    """Add the boxes of appended features, whose numbers follow the last one."""
    theirs, ours = (_quote(f"rtree_{name}_{geometry}") for name in (layer, there))
    if not _has_table_in(file, "main", f"rtree_{there}_{geometry}"):
        return
    rows = file.execute(f"SELECT rowid FROM made.{_quote(layer)} ORDER BY rowid").fetchall()
    number = {row: last + i for i, (row,) in enumerate(rows, start=1)}
    file.executemany(
        f"INSERT INTO main.{ours} VALUES (?, ?, ?, ?, ?)",
        [
            (number[fid], *box)
            for fid, *box in file.execute(f"SELECT * FROM made.{theirs}").fetchall()
        ],
    )


def _update_counts(file: sqlite3.Connection, layer: str, there: str) -> None:
    """Let extent and count of a layer hold what was appended."""
    box = ("min_x", "min_y", "max_x", "max_y")
    of_layer = "WHERE lower(table_name) = lower(?)"
    new = _ask(file, f"SELECT {', '.join(box)} FROM made.gpkg_contents {of_layer}", layer)
    for name, value, choose in zip(box, new, ("min", "min", "max", "max"), strict=True):
        file.execute(
            f"UPDATE main.gpkg_contents SET {name} = coalesce({choose}({name}, ?1), {name}, ?1) "
            "WHERE lower(table_name) = lower(?2)",
            (value, there),
        )
    if _has_table_in(file, "main", "gpkg_ogr_contents"):
        file.execute(
            "UPDATE main.gpkg_ogr_contents SET feature_count = "
            f"(SELECT count(*) FROM main.{_quote(there)}) WHERE lower(table_name) = lower(?)",
            (there,),
        )


def _remove(file: sqlite3.Connection, layer: str) -> None:
    of_layer = "WHERE lower(table_name) = lower(?)"
    row = _ask(file, f"SELECT column_name FROM main.gpkg_geometry_columns {of_layer}", layer)
    triggers = file.execute(
        "SELECT name FROM main.sqlite_master WHERE type = 'trigger' AND lower(tbl_name) = lower(?)",
        (layer,),
    ).fetchall()
    for (name,) in triggers:
        file.execute(f"DROP TRIGGER main.{_quote(name)}")
    if row is not None:
        file.execute(f"DROP TABLE IF EXISTS main.{_quote(f'rtree_{layer}_{row[0]}')}")
    (kind,) = _ask(
        file,
        "SELECT type FROM main.sqlite_master WHERE name = ? AND type IN ('table', 'view')",
        layer,
    )
    file.execute(f"DROP {kind} main.{_quote(layer)}")
    if _has_table_in(file, "main", "gpkg_metadata_reference"):
        numbers = file.execute(
            f"SELECT md_file_id FROM main.gpkg_metadata_reference {of_layer}", (layer,)
        ).fetchall()
        file.execute(f"DELETE FROM main.gpkg_metadata_reference {of_layer}", (layer,))
        for (number,) in numbers:
            file.execute(
                "DELETE FROM main.gpkg_metadata WHERE id = ? AND NOT EXISTS (SELECT 1 FROM "
                "main.gpkg_metadata_reference WHERE md_file_id = ? OR md_parent_id = ?)",
                (number, number, number),
            )
    for register in (*_OF_TILES, *reversed(_REGISTERS)):
        if _has_table_in(file, "main", register):
            file.execute(f"DELETE FROM main.{register} {of_layer}", (layer,))


def _ask(file: sqlite3.Connection, question: str, *values: Any) -> Any:
    """Return the first row of an answer; None if there is none."""
    return file.execute(question, values).fetchone()


def _list_rows(file: sqlite3.Connection, table: str, layer: str = "") -> list[dict[str, Any]]:
    """Return the rows of the new file's table, of a layer or all, in columns that both have."""
    theirs = _list_columns(file, "main", table)
    columns = [name for name in _list_columns(file, "made", table) if name in theirs]
    condition = " WHERE lower(table_name) = lower(?)" if layer else ""
    rows = file.execute(
        f"SELECT {', '.join(map(_quote, columns))} FROM made.{table}{condition}",
        (layer,) if layer else (),
    ).fetchall()
    return [dict(zip(columns, row, strict=True)) for row in rows]


def _insert(file: sqlite3.Connection, table: str, values: dict[str, Any]) -> None:
    listed, marks = ", ".join(map(_quote, values)), ", ".join("?" * len(values))
    file.execute(
        f"INSERT OR REPLACE INTO main.{table} ({listed}) VALUES ({marks})", list(values.values())
    )


def _has_table_in(file: sqlite3.Connection, schema: str, name: str) -> bool:
    question = f"SELECT 1 FROM {schema}.sqlite_master WHERE lower(name) = lower(?)"
    return _ask(file, question, name) is not None


def _list_columns(file: sqlite3.Connection, schema: str, table: str) -> list[str]:
    found = file.execute(f"PRAGMA {schema}.table_info({_quote(table)})")
    return [name for _, name, *_ in found]


def _quote(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


_ENDS = ("-wal", "-journal")
"""SQLite would play what is in these into any file of that name."""


def require_closed(path: Path) -> None:
    """Refuse to write a GeoPackage that another program works on."""
    for end in _ENDS:
        journal = path.with_name(path.name + end)
        if journal.exists():
            raise WriteError(
                f"Cannot write {FILE}: it is open in another program, as '{journal.name}' beside "
                "it shows; close it there first."
            )
