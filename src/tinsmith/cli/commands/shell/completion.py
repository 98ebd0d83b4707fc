"""``tinsmith completion``: the script by which a shell completes what is typed."""

from __future__ import annotations

import click

from ...command import command
from ...output import emit_text
from ...parameters import Words

_VARIABLE = "_TINSMITH_COMPLETE"
"""What click asks for in the environment, by the name of the program."""


@command
@click.argument("shell", type=Words(("bash", "zsh", "fish")))
@click.pass_context
def completion(ctx: click.Context, shell: str) -> None:
    """Write the completion script for SHELL to standard output.

    It completes commands, options, their values, formats and files.

    Example:
      tinsmith completion bash >> ~/.bashrc
      tinsmith completion zsh >> ~/.zshrc
      tinsmith completion fish > ~/.config/fish/completions/tinsmith.fish
    """
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    if kind is None:  # pragma: no cover - click has all three
        raise click.UsageError(f"No completion for '{shell}'.")
    script = kind(ctx.find_root().command, {}, "tinsmith", _VARIABLE)
    emit_text(script.source_template % script.source_vars())
