"""Options that many commands have, folded into one line at the end of ``--help``."""

from __future__ import annotations

from typing import Any

#: Option -> its words in that line.
_COMMON = {
    "--plugin": "--plugin PATH loads a plugin that is not installed (repeatable)",
    "--no-plugins": "--no-plugins loads crowdbot's own only",
    "--verbose": "-v prints more",
    "--quiet": "-q prints errors only",
    "--help": "-h shows this help",
}


def fold_common(command: Any) -> None:
    """Let the help of a command show common options as one line, below its own.

    They stay visible to the completion of shells.
    """
    common = [p for p in command.params if set(p.opts) & _COMMON.keys() and not p.hidden]
    names = {name for param in common for name in param.opts} | {"--help"}
    line = f"Common options: {'; '.join(w for name, w in _COMMON.items() if name in names)}."
    command.epilog = f"{command.epilog}\n\n{line}" if command.epilog else line
    plain = command.format_help

    def format_help(ctx: Any, formatter: Any) -> None:
        own = command.get_help_option(ctx)
        folded = [*common, *([own] if own is not None else [])]
        for param in folded:
            param.hidden = True
        try:
            plain(ctx, formatter)
        finally:
            for param in folded:
                param.hidden = False

    command.format_help = format_help
