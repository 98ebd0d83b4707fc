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
