"""Flags made of the signatures and docstrings of readers and writers."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path

import click
import pytest
from click.testing import CliRunner
from support import commands

import tinsmith as ts
import tinsmith.cli
from tinsmith.cli import main
from tinsmith.cli.command_list import SUMMARIES
from tinsmith.io import known_formats

run = commands.run
ROWS = "easting;northing;elevation\n0;0;1\n4;0;2\n0;3;4\n5;5;2.5\n"
WAYS = [
    (one, way)
    for one in known_formats()
    for way in ("read", "write")
    if getattr(one, way) is not None
]
OWN = {"read": {"source_crs", "unit"}, "write": {"layer"}}


@pytest.fixture
def survey(tmp_path):
    path = tmp_path / "survey.csv"
    path.write_text(ROWS)
    return path


def help_of(*arguments):
    result = CliRunner().invoke(main, [*map(str, arguments), "--help"], terminal_width=300)
    assert result.exit_code == 0, result.output
    return result.output


def count_options(text):
    """Count the options that a help lists, but for --help itself."""
    found = re.findall(r"^  (?:-\w, )?--[a-z-]+", text, re.MULTILINE)
    return len(found) - sum(one.endswith("--help") for one in found)


@pytest.mark.parametrize(("one", "way"), WAYS, ids=lambda one: getattr(one, "name", one))
def test_every_option_of_a_format_is_described(one, way):
    for option in one.describe_options(way):
        assert option.text or option.kind.startswith("{"), f"{getattr(one, way)}: {option.name}"
    assert one.options(way) == tuple(option.name for option in one.describe_options(way))


@pytest.mark.parametrize(("one", "way"), WAYS, ids=lambda one: getattr(one, "name", one))
def test_the_help_of_a_command_lists_the_options_of_the_format_at_hand(one, way):
    given = ("in", "--format", one.name) if way == "read" else ("in", "--output-format", one.name)
    shown = help_of("convert", *given)
    for option in one.describe_options(way):
        if option.name not in OWN[way]:
            plain, prefixed = option.name.replace("_", "-"), f"--output-{option.name}"
            assert f"--{plain}" in shown or prefixed in shown, option.name


def test_formats_lists_the_flags_of_a_format():
    shown = run("formats", "csv").output
    assert "delimited: Delimited text" in shown
    assert "csv: CSV" in shown
    for flag in ("--columns", "--skip-bad", "--header / --no-header"):
        assert flag in shown
    assert "--stride" not in shown
    record = json.loads(run("formats", "stl", "--json").output)
    (stl,) = record["formats"]
    assert [one["name"] for one in stl["options"]["write"]] == list(
        ts.find_format("stl").options("write")
    )


def test_formats_names_the_nearest_format():
    told = commands.refuse("formats", "geojsn", code=2)
    assert "Unknown format 'geojsn'" in told
    assert "Did you mean 'geojson'" in told


def test_a_flag_is_that_of_the_input_where_both_have_it(survey):
    path = survey.with_name("out.csv")
    run("convert", survey, "--delimiter", "semicolon", "--output-delimiter", "|", "-o", path)
    assert path.read_text().splitlines()[1].count("|") >= 2
    mesh = survey.with_name("site.ply")
    run("build", survey, "-o", mesh)
    run("convert", mesh, "--columns", "ENZ", "--no-header", "-o", path)
    assert len(path.read_text().splitlines()) == 4


def test_options_that_only_readers_had_are_taken(tmp_path):
    path = tmp_path / "notes.csv"
    path.write_text(ROWS.replace(";", ",").replace("0,0,1", "!! datum\n0,0,1"), "utf-16")
    record = json.loads(
        run("info", path, "--comment", "!!", "--encoding", "utf-16", "--json").output
    )
    assert record["points"] == 4


@pytest.mark.parametrize("name", SUMMARIES)
def test_no_flag_stands_twice_in_the_help(name):
    command = main.get_command(click.Context(main), name)
    arguments = ["a.csv", "a.tif", "a.las", "a.xml", "-o", "b.stl", "-o", "c.gpkg", "-o", "d.csv"]
    with click.Context(command, resilient_parsing=True) as context:
        command.parse_args(context, arguments)
        found = [flag for one in command.get_params(context) for flag in one.opts]
    assert len(found) == len(set(found))


def test_an_option_of_another_format_is_refused_by_its_name(survey):
    told = commands.refuse(
        "build", survey, "--stride", "2", "-o", survey.with_name("a.ply"), code=1
    )
    assert "stride" in told
    assert "delimited" in told
    assert not survey.with_name("a.ply").exists()


def test_a_flag_that_nobody_has_is_refused_with_the_nearest(survey):
    told = commands.refuse("build", survey, "--colums", "ENZ", "-o", "a.ply", code=2)
    assert "No such option" in told
    assert "--columns" in told


def test_the_help_of_all_commands_lists_less_than_500_options():
    assert sum(count_options(help_of(name)) for name in SUMMARIES) < 500


NAMED = {
    "raster": "the name of a command",
    "tin": "the kind of what `info` describes",
    ".json": "reports are JSON whatever the formats are",
}
"""What may stand in the commands besides sentences, though formats are called so, and why."""


def list_words(path):
    """Return the texts of a module that are no sentences and no documentation."""
    nodes = list(ast.walk(ast.parse(path.read_text())))
    bare = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    texts = [node for node in nodes if isinstance(node, ast.Constant) and id(node) not in bare]
    return [node.value for node in texts if isinstance(node.value, str) and " " not in node.value]


def test_the_commands_know_no_format():
    formats = known_formats()
    suffixes = tuple({suffix for one in formats for suffix in one.suffixes})
    names = {one.name for one in formats} | {"png"}
    folder = Path(tinsmith.cli.__file__).parent
    for path in folder.rglob("*.py"):
        words = [word for word in list_words(path) if word not in NAMED]
        found = [word for word in words if word in names or word.lower().endswith(suffixes)]
        assert not found, f"{path.relative_to(folder)}: {found}"
