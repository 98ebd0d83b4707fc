"""Programs of other packages that a benchmark runs, if they are installed."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence

from ..measure import Outcome

__all__ = ["find_present", "run_program"]


def find_present(tools: Mapping[str, str], outcome: Outcome) -> list[str]:
    """Return the tools whose program is installed; note the others.

    Parameters
    ----------
    tools : mapping of str to str
        The program of each tool.
    """
    missing = {
        tool: f"{program} is not installed"
        for tool, program in tools.items()
        if shutil.which(program) is None
    }
    outcome.skip(missing)
    return [tool for tool in tools if tool not in missing]


def run_program(command: Sequence[object]) -> None:
    """Run a program to its end.

    Raises
    ------
    RuntimeError
        With what it says, if it fails.
    """
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{words[0]} failed: {done.stderr.strip()[-500:]}")
