"""The command line, called in this process."""

from click.testing import CliRunner

from tinsmith.cli import main


def run(*arguments):
    """Run ``tinsmith`` with arguments of any type; return what click tells, whatever its code."""
    return CliRunner().invoke(main, list(map(str, arguments)))


def run_command(*arguments, code=0):
    """Run ``tinsmith`` with arguments of any type; it must end with that exit code."""
    result = run(*arguments)
    assert result.exit_code == code, result.output
    return result


def refuse(*arguments, code=None, folder=None, left=()):
    """Run what must be refused in sentences, leaving no file in a folder but those named."""
    result = run(*arguments)
    assert result.exit_code in ((1, 2) if code is None else (code,)), result.output
    assert "Traceback" not in result.output
    assert "bug" not in result.output
    if folder is not None:
        assert sorted(folder.iterdir()) == sorted(left)
    return result.stderr
