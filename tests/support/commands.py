"""The command line, called in this process."""

from click.testing import CliRunner

from tinsmith.cli import main


def run_command(*arguments, code=0):
    """Run ``tinsmith`` with arguments of any type; it must end with that exit code."""
    result = CliRunner().invoke(main, [str(one) for one in arguments])
    assert result.exit_code == code, result.output
    return result
