"""``crowdbot recover``: restore an interrupted recording."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import argument, option
from crowdbot.cli.shared.run_arguments import AsJson


def recover(
    file: Annotated[Path, argument("FILE|DIR.partial", "An interrupted recording.")],
    out: Annotated[Path | None, option("FILE", "File to write; default: beside it.")] = None,
    as_json: AsJson = False,
) -> None:
    """Make a complete recording from an interrupted one; all but its last second is kept.

    Example: crowdbot recover runs/challenge-2020/in-d0125-slow-c01-r02/dwa/seed-0.partial
    """
    from crowdbot.core.recording.reading.recover import recover as recover_it
    from crowdbot.core.runs.run_directory import RECORDING
    from crowdbot.errors import InputError

    path = file / RECORDING if file.is_dir() else file
    target = out or path.with_name(f"{path.name.removesuffix('.mcap')}.recovered.mcap")
    if target.exists():
        raise InputError(f"{target}: exists already; it is not written over")
    found = recover_it(path, target)
    if as_json:
        say(json.dumps({"file": str(target), "messages": found.messages, "duration": found.end}))
        return
    say(f"{target}: {found.messages} messages, {found.end:.2f} s, marked as recovered")
