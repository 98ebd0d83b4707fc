"""Other programs, run to their end."""

from __future__ import annotations

import os
import subprocess
import sys

__all__ = ["run", "run_alone"]


def run(*command, cwd=None, **environment):
    """Run a command with some environment variables changed; its output is captured as text."""
    return subprocess.run(
        command,
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def run_alone(code):
    """Run Python in an interpreter of its own, which must end well and print no warning."""
    done = run(sys.executable, "-W", "error", "-c", code)
    assert (done.returncode, done.stderr) == (0, "")
