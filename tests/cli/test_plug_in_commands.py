"""Commands of plug-ins: beside the built-in ones, and harmless where they are at fault."""

from __future__ import annotations

import json

import click
import pytest
from support import plug_ins
from support.commands import run_command as run
from support.plug_ins import Entry


@pytest.fixture
def install(monkeypatch):
    """Return a function that makes entries the installed commands."""
    yield lambda *entries: plug_ins.install(monkeypatch, *entries, group="tinsmith.commands")
    monkeypatch.undo()
    plug_ins.forget()


def hello():
    return click.Command(
        "hello", callback=lambda: click.echo("hi"), short_help="Say it.", params=[]
    )


def test_command_is_added_under_its_own_heading(install):
    install(Entry("hello", hello()))
    assert run("hello").stdout == "hi\n"
    result = run("--help")
    built_in, added = result.stdout.split("Commands of plug-ins:")
    assert "build" in built_in
    assert "hello" not in built_in
    assert added.split() == ["hello", "Say", "it."]
    assert result.stderr == ""


def test_no_heading_without_plug_ins(install):
    install()
    assert "plug-ins" not in run("--help").stdout


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (ImportError("no module 'x'"), "ImportError: no module 'x'"),
        (SystemExit(1), "SystemExit: 1"),
        ("a text", "it is a str, not a click command"),
    ],
)
def test_broken_command_says_so_and_harms_no_other(install, value, reason):
    install(Entry("broken", value), Entry("hello", hello()))
    sentence = f"The plug-in 'broken' of ground-plus 1.2 cannot be loaded ({reason}): repair or"
    result = run("--help")
    assert result.stderr.startswith(f"Warning: {sentence}")
    assert result.stderr.count("\n") == 1
    assert "hello" in result.stdout
    assert sentence in run("broken", "--option", "x", code=1).stderr
    assert run("formats", "-q").stderr == ""


def test_built_in_command_is_not_replaced_and_that_is_told(install):
    mine = click.Command("formats", callback=lambda: click.echo("mine"))
    install(Entry("formats", mine))
    result = run("formats", "--json")
    assert json.loads(result.stdout)["formats"]
    warning = "Warning: The command 'formats' of the plug-in ground-plus 1.2 is left out"
    assert result.stderr.startswith(warning)
    assert warning in run("--help").stderr
    assert "plug-ins:" not in run("--help").stdout


def test_two_commands_of_one_name_are_refused_where_it_is_used(install):
    install(Entry("hello", hello()), Entry("hello", hello(), "twins", "3.0"))
    sentence = "Two plug-ins have a command 'hello', ground-plus 1.2 and twins 3.0: uninstall one."
    assert sentence in run("hello", code=1).stderr
    assert sentence in run("--help").stderr


def test_bug_of_a_plug_in_is_its_own(install):
    install(Entry("hello", click.Command("hello", callback=lambda: 1 / 0)))
    assert "A bug in the plug-in ground-plus 1.2: ZeroDivisionError" in run("hello", code=1).stderr
