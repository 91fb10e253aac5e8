"""``crowdbot doctor``: check that this machine can run crowdbot."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.output.say import say


def doctor(
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Where runs would go; its disk is checked.")
    ] = Path("runs"),
    self_test: Annotated[
        bool, typer.Option(help="Simulate for a moment; takes about 10 s, more the first time.")
    ] = True,
    as_json: Annotated[bool, typer.Option("--json", help="JSON on stdout.")] = False,
) -> None:
    """Check versions, graphics, compiled kernels, cores and disk, and simulate for a moment.

    Exit code 1 if something is missing that runs need.

    Example: crowdbot doctor --no-self-test
    """
    from crowdbot.cli.output import doctor as _doctor

    findings = list(_doctor.machine(out))
    if self_test:
        if logging.getLogger("crowdbot").level <= logging.INFO and not as_json:
            say("simulating for a moment ...", err=True)
        findings.append(_doctor.self_test())
    if as_json:
        say(json.dumps([f._asdict() for f in findings], indent=2))
    else:
        quiet = logging.getLogger("crowdbot").level > logging.INFO
        for found in findings:
            if not quiet or found.verdict != "ok":
                say(f"{found.verdict:<8} {found.what:<12} {found.found}")
    if any(f.verdict == "missing" for f in findings):
        raise typer.Exit(1)
