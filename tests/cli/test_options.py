"""What the help of every command says of its options."""

from __future__ import annotations

import click
import pytest
from click.testing import CliRunner

from tinsmith.cli import main

COMMANDS = [(), *((name,) for name in main.list_commands(click.Context(main)))]


def command_of(name):
    return main.get_command(click.Context(main), *name) if name else main


@pytest.mark.parametrize("name", COMMANDS, ids="-".join)
def test_defaults_are_shown_where_they_say_something(name):
    """Of flags, files and what is found by looking there is none to show."""
    result = CliRunner().invoke(main, [*name, "--help"], terminal_width=200)
    assert result.exit_code == 0
    with click.Context(command_of(name)) as context:
        options = [one for one in command_of(name).params if isinstance(one, click.Option)]
        for option in options:
            default = option.get_default(context)
            is_said = isinstance(default, int | float | str) and not isinstance(default, bool)
            record = option.get_help_record(context)
            assert record is not None
            assert (f"[default: {default}" in record[1]) == is_said, option.name


@pytest.mark.parametrize(
    ("arguments", "flag"),
    [
        (("grade", "a.csv", "--pad", "b.shp", "--pad", "c.shp"), "--pad"),
        (("profile", "a.csv", "--from", "1", "2", "--to", "3", "4", "--from", "5", "6"), "--from"),
        (("build", "a.csv", "--crs", "EPSG:32616", "--crs=EPSG:32617"), "--crs"),
    ],
)
def test_an_option_of_one_value_is_not_given_twice(arguments, flag):
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 2
    assert f"Error: {flag} is given several times: it takes one." in result.output


def test_flags_and_options_of_many_values_are_given_as_often_as_one_likes():
    result = CliRunner().invoke(main, ["build", "-q", "-q", "-o", "a.ply", "-o", "b.ply", "--help"])
    assert result.exit_code == 0, result.output
