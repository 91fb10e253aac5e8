"""``crowdbot doctor``: check that this machine can run crowdbot."""

from __future__ import annotations

import logging
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.run_arguments import AsJson


def doctor(
    out: Annotated[Path, option("DIR", "Where runs would go; its disk is checked.")] = Path("runs"),
    self_test: Annotated[
        bool,
        typer.Option(help="Simulate for a moment, too: about 10 s, more the first time."),
    ] = False,
    licences: Annotated[
        bool, switch("--licences", "List all packages that crowdbot needs, and end.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Check versions, graphics, compiled kernels, cores and disk; simulate for a moment if asked.

    Exit code 1 if something is missing that runs need.

    Example: crowdbot doctor --self-test
    """
    from crowdbot.cli.output import doctor as _doctor

    if licences:
        _print_licences(as_json=as_json)
        return
    findings = list(_doctor.machine(out))
    if self_test:
        if logging.getLogger("crowdbot").level <= logging.INFO and not as_json:
            say("simulating for a moment ...", err=True)
        findings.append(_doctor.self_test())
    if as_json:
        say_json([f._asdict() for f in findings])
    else:
        quiet = logging.getLogger("crowdbot").level > logging.INFO
        for found in findings:
            if not quiet or found.verdict != "ok":
                say(f"{found.verdict:<8} {found.what:<12} {found.found}")
        if not (self_test or quiet):
            say("--self-test simulates for a moment, too")
    if any(f.verdict == "missing" for f in findings):
        raise typer.Exit(1)


def _print_licences(*, as_json: bool) -> None:
    """Print the packages that crowdbot needs, with version and licence."""
    from crowdbot.core.support.dependencies import dependencies

    found = dependencies()
    if as_json:
        say_json([asdict(one) for one in found])
        return
    for one in found:
        extra = " (extra)" if one.extra else ""
        say(f"{one.name + extra:<36} {one.version:<16} {one.licence or 'not stated'}")
