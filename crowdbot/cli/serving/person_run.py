"""A run with a person at a web page: its request, the page, and servers for other programs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.serving.serve_arguments import DistroChoice
from crowdbot.cli.serving.serve_options import Listen, listening_also, needs
from crowdbot.errors import UsageError

if TYPE_CHECKING:
    from crowdbot.core.live.person.page import Mode
    from crowdbot.core.live.person.page_server import PageServer
    from crowdbot.core.live.person.seat import Seat
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.runs.run import Request, Run


@dataclass(frozen=True, kw_only=True)
class PersonRun:
    """The arguments of a command that puts a person into a run.

    Attributes:
        record: which sensors are simulated.
        duration: duration of a run without a robot, s; None: default.
    """

    spec: str
    scenario: str | None
    overrides: Sequence[str]
    seed: int
    out: Path
    record: Literal["all", "used", "none"]
    references: bool
    duration: float | None = None


@dataclass(frozen=True, kw_only=True)
class PagePorts:
    """Ports of the person's page and of the servers for other programs.

    Attributes:
        port: port of the page; ``open_`` shows it in the browser.
        rosbridge, zenoh: port and endpoint for programs; None: closed.
        rate: times real time.
    """

    port: int = 0
    open_: bool = False
    rosbridge: int | None = None
    zenoh: str | None = None
    rate: float = 1.0


def request_of(given: PersonRun, registry: Registry) -> Request:
    """Return the request of the run; the planner is chosen later.

    Raises:
        InputError: the scenario is wrong, or there is no such one.
    """
    from crowdbot.core.planning.choice import NO_ROBOT
    from crowdbot.core.runs.run import Request
    from crowdbot.core.runs.run_options import RunOptions
    from crowdbot.core.scenarios.library import open_spec, pick

    expansion = open_spec(given.spec, registry, given.overrides)
    chosen = pick(expansion, given.scenario)
    return Request(
        scenario=chosen,
        choice=NO_ROBOT,
        registry=registry,
        seed=given.seed,
        out=given.out,
        entry=expansion.entry(chosen),
        options=RunOptions(
            record=given.record,
            references=given.references,
            metrics=expansion.metrics,
            duration=given.duration,
        ),
    )


@contextmanager
def page_of(seat: Seat, mode: Mode, scenario: str, ports: PagePorts) -> Iterator[PageServer]:
    """Serve a person's page, and the servers for other programs, until the run ends.

    Raises:
        MissingLibraryError: the extra ``live`` is not installed.
        InputError: a port is not available.
    """
    needs("live", "websockets")
    from crowdbot.core.live.person.page import render_person_page
    from crowdbot.core.live.person.page_server import PageServer

    if not math.isfinite(ports.rate):
        raise UsageError("--rate wants a number, such as --rate 0.5")
    with ExitStack() as stack:
        name = "teleop" if mode == "drive" else "walk"
        server = PageServer(seat, render_person_page(mode, scenario), ports.port, name)
        stack.callback(server.close)
        listen = Listen(
            host="127.0.0.1", port=ports.rosbridge or 0, token=None, ros=2, zenoh=ports.zenoh,
            distro=DistroChoice.jazzy,
        )  # fmt: skip
        stack.enter_context(
            listening_also(seat.session, listen, rosbridge=ports.rosbridge is not None)
        )
        say(f"{name}: {server.url}", err=True)
        if ports.open_:
            typer.launch(server.url)
        yield server


def show_end(server: PageServer, run: Run) -> None:
    """Show on all open pages how a run ended."""
    when = run.record.goal_time or run.record.sim_time
    server.show_end(
        reason=run.record.status.sentence.format(t=when),
        status=str(run.record.status),
        directory=str(run.directory),
        last=True,
    )
