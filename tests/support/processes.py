"""Other programs, run to their end."""

from __future__ import annotations

import os
import subprocess

__all__ = ["run"]


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
