"""Completion by shells, the nearest word where one is misspelt, and help by subject."""

from __future__ import annotations

import re
import shutil
import sys
from functools import cache
from importlib import import_module

import click
import pytest
from click.shell_completion import ShellComplete
from support.commands import run_command
from support.processes import run

from tinsmith.cli import main
from tinsmith.cli.command import LISTED_BY, Command
from tinsmith.cli.command_list import FOLDERS, SECTIONS, SUMMARIES
from tinsmith.io import known_formats


def complete(*typed):
    *before, incomplete = typed
    shell = ShellComplete(main, {}, "tinsmith", "_TINSMITH_COMPLETE")
    return shell.get_completions(list(before), incomplete)


def values(*typed):
    return [one.value for one in complete(*typed)]


def test_commands_options_and_words_are_completed():
    assert values("con") == ["convert", "contours"]
    assert values("build", "--dup") == ["--duplicates"]
    assert values("build", "--duplicates", "l") == ["last", "lowest"]
    assert values("completion", "") == ["bash", "zsh", "fish"]


@pytest.mark.parametrize(("flag", "way"), [("--format", "read"), ("--output-format", "write")])
def test_formats_are_completed(flag, way):
    able = [one.name for one in known_formats() if getattr(one, way) is not None]
    assert values("convert", flag, "") == able
    assert values("convert", flag, "geoj") == [name for name in able if name.startswith("geoj")]


@pytest.mark.parametrize(
    "typed", [("build", "sit"), ("build", "-o", "sit"), ("build", "--boundary", "sit")]
)
def test_files_are_left_to_the_shell(typed):
    assert [(one.value, one.type) for one in complete(*typed)] == [("sit", "file")]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_scripts_call_this_command(shell):
    script = run_command("completion", shell).output
    assert "_TINSMITH_COMPLETE" in script
    assert f"{shell}_complete" in script
    if shutil.which(shell):
        assert run(shell, "-n", "-c", script).returncode == 0


def test_bash_completes_what_is_typed(tmp_path):
    (tmp_path / "completion").write_text(run_command("completion", "bash").output)
    program = tmp_path / "tinsmith"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m tinsmith "$@"\n')
    program.chmod(0o755)
    script = (
        "complete() { :; }; source ./completion; COMP_WORDS=(./tinsmith convert --outp); "
        'COMP_CWORD=2; _tinsmith_completion ./tinsmith; echo "${COMPREPLY[*]}"'
    )
    result = run("bash", "-c", script, cwd=tmp_path)
    assert result.stdout.split() == ["--output", "--output-format"], result.stderr


# -------------------------------------------------------------------- the nearest word


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (("biuld",), "'build'"),
        (("volumes", "a.ply"), "'volume'"),
        (("build", "a.csv", "--duplicates", "meann"), "'mean'"),
        (("build", "a.csv", "--breakline", "b.shp"), "'--breaklines'"),
        (("build", "a.csv", "-o", "a.ply", "--format", "delimted"), "'delimited'"),
        (("completion", "bsh"), "'bash'"),
    ],
)
def test_the_nearest_word_is_named(arguments, meant):
    output = run_command(*arguments, code=2).output
    assert "Did you mean" in output
    assert meant in output


@pytest.mark.parametrize("arguments", [("xyzzy",), ("build", "a.csv", "--duplicates", "xyzzy")])
def test_nothing_near_is_not_named(arguments):
    assert "Did you mean" not in run_command(*arguments, code=2).output


# -------------------------------------------------------------------- help by subject


def test_every_command_has_its_line_in_the_help():
    lines = " ".join(run_command("--help").output.split())
    for heading, summaries in SECTIONS.items():
        assert f"{heading}: " in lines
        for name, summary in summaries.items():
            assert f"{name} {summary}" in lines
            command = getattr(import_module(f"tinsmith.cli.commands.{FOLDERS[name]}.{name}"), name)
            assert isinstance(command, Command)


@cache
def show_help(name):
    return run_command(name, "--help").output


@pytest.mark.parametrize("name", SUMMARIES)
def test_every_option_is_listed_once_under_a_subject(name):
    command = main.get_command(click.Context(main), name)
    output = show_help(name)
    for option in command.params:
        if isinstance(option, click.Option):
            lister = LISTED_BY.get(getattr(option, "subject", ""), name)
            is_elsewhere = lister != name
            place = show_help(lister) if is_elsewhere else output
            assert option.opts[-1] in place
            assert any(
                re.match(rf" *(-\w, )?{option.opts[-1]}( |$)", one) for one in place.splitlines()
            )
            if is_elsewhere:
                assert option.subject.lower() in " ".join(output.split())
    headings = [line for line in output.splitlines() if line.endswith(":") and line[:1] != " "]
    assert headings[0] == "Options:"
    assert len(set(headings)) == len(headings)
