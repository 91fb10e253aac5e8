"""Evaluate the options of ``crowdbot serve``."""

from __future__ import annotations

import math
import secrets
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from crowdbot.cli.output.say import say
from crowdbot.cli.serving.serve_arguments import ClockChoice, DistroChoice, MissedChoice
from crowdbot.errors import MissingLibraryError, UsageError

if TYPE_CHECKING:
    from crowdbot.core.live.live_connection import LiveConnection
    from crowdbot.core.live.services import Service
    from crowdbot.core.live.session import LiveSession
    from crowdbot.core.live.step_policy import StepPolicy
    from crowdbot.core.recording.watcher import Watcher
    from crowdbot.core.runs.run_record import RunRecord


#: Opens a server for external programs.
_Server = Callable[["LiveSession", "StepPolicy", "Listen"], "LiveConnection"]


@dataclass(frozen=True, kw_only=True)
class Listen:
    """Options of the servers: addresses, access rules and protocols."""

    host: str
    port: int
    token: str | None
    ros: int
    connect: str | None = None
    stamped: bool = False
    zenoh: str | None = None
    zenoh_router: bool = False
    domain: int = 0
    distro: DistroChoice = DistroChoice.jazzy
    foxglove: int | None = None
    origins: Sequence[str] = ()


def step_policy_of(
    rate: float | None,
    clock: ClockChoice,
    missed: MissedChoice,
    times: Mapping[str, float | None],
    epoch: int,
) -> StepPolicy:
    """Return the timing of a live run's steps.

    Args:
        times: values of ``budget``, ``hold`` and ``wait``, s.

    Raises:
        UsageError: two options contradict each other, or a number is out of range.
    """
    from crowdbot.core.live.step_policy import StepPolicy

    external = clock is ClockChoice.external
    if external and rate is not None:
        raise UsageError("--rate and --clock external exclude each other: who says the time?")
    for name, value in {"rate": rate, **times}.items():
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise UsageError(f"--{name} must be above 0, not {value:g}")
    wait = times["wait"]
    return StepPolicy(
        rate=rate,
        external_clock=external,
        budget=times["budget"] or 0.0,
        missed=missed.value,
        hold=times["hold"] or 0.0,
        wait=math.inf if wait is None else wait,
        epoch=epoch * 10**9,
    )


def listening(
    session: LiveSession, policy: StepPolicy, listen: Listen
) -> AbstractContextManager[list[LiveConnection]]:
    """Open the servers for external programs; they are closed when the context ends.

    Raises:
        MissingLibraryError: the extra ``live`` is not installed.
        InputError: the address is not available.
    """
    first = _rosbridge if listen.connect is None else _connected
    return _opened(session, policy, listen, [first])


def listening_also(
    session: LiveSession, listen: Listen, *, rosbridge: bool
) -> AbstractContextManager[list[LiveConnection]]:
    """Open further servers beside a person's page; they are closed when the context ends."""
    from crowdbot.core.live.step_policy import StepPolicy

    policy = StepPolicy(rate=1.0)
    return _opened(session, policy, listen, [_rosbridge] * rosbridge)


@contextmanager
def _opened(
    session: LiveSession, policy: StepPolicy, listen: Listen, first: Sequence[_Server]
) -> Iterator[list[LiveConnection]]:
    """Open the given servers, and Zenoh and Foxglove if the options name them."""
    more = {_zenoh: listen.zenoh, _foxglove: listen.foxglove}
    with ExitStack() as stack:
        connections: list[LiveConnection] = []
        for server in (*first, *(s for s, place in more.items() if place is not None)):
            connections.append(server(session, policy, listen))
            stack.callback(connections[-1].close)
        yield connections


def _connected(session: LiveSession, policy: StepPolicy, listen: Listen) -> LiveConnection:
    from crowdbot.core.live.rosbridge.client import RosbridgeClient

    needs("live", "websockets")
    assert listen.connect is not None
    connection = RosbridgeClient(
        session,
        listen.connect,
        ros=1 if listen.ros == 1 else 2,
        stamped=listen.stamped,
        external_clock=policy.external_clock,
    )
    _say(f"rosbridge: connected to {listen.connect}; waiting for commands on {_topics(session)}")
    return connection


def _foxglove(session: LiveSession, policy: StepPolicy, listen: Listen) -> LiveConnection:
    needs("live", "foxglove")
    from crowdbot.core.live.admission import Admission, is_loopback
    from crowdbot.core.live.foxglove.server import FoxgloveServer

    if not is_loopback(listen.host):
        raise UsageError("--foxglove knows no token: it listens on this machine only")
    admission = Admission(server="foxglove", origins=listen.origins)
    connection = FoxgloveServer(
        session, listen.host, listen.foxglove or 0, _services(session), policy.epoch, admission
    )
    _say(f"foxglove: ws://{listen.host}:{connection.port}")
    return connection


def _topics(session: LiveSession) -> str:
    return ", ".join(session.commands)


def _zenoh(session: LiveSession, policy: StepPolicy, listen: Listen) -> LiveConnection:
    needs("ros2", "zenoh")
    from crowdbot.core.live.zenoh_connection import Network, ZenohConnection

    connection = ZenohConnection(
        session,
        Network(
            endpoint=listen.zenoh or "",
            router=listen.zenoh_router,
            domain=listen.domain,
            distro=listen.distro.value,
        ),
        _services(session),
        resend=policy.lockstep,
        external_clock=policy.external_clock,
    )
    role = "router at" if listen.zenoh_router else "connected to"
    _say(f"ROS 2 ({listen.distro.value}, domain {listen.domain}): zenoh, {role} {listen.zenoh}")
    return connection


def _rosbridge(session: LiveSession, policy: StepPolicy, listen: Listen) -> LiveConnection:
    from crowdbot.core.live.admission import is_loopback
    from crowdbot.core.live.rosbridge.server import Address, RosbridgeServer

    needs("live", "websockets", "cbor2")
    token = listen.token or ""
    if not is_loopback(listen.host):
        token = token or secrets.token_urlsafe(16)
        _say(
            f"warning: {listen.host} can be reached from other machines; rosbridge is not "
            "encrypted, and anyone with the token can drive the robot"
        )
    server = RosbridgeServer(
        session,
        Address(host=listen.host, port=listen.port, token=token, origins=listen.origins),
        _services(session),
        ros=1 if listen.ros == 1 else 2,
        resend=policy.lockstep,
        external_clock=policy.external_clock,
    )
    shown = f"[{listen.host}]" if ":" in listen.host else listen.host
    query = f"/?token={token}" if token else ""
    clients = "clients that drive" if len(session.robots) > 1 else "a client that drives"
    _say(f"rosbridge: ws://{shown}:{server.port}{query}; waiting for {clients} {_topics(session)}")
    return server


def watchers_of(connections: Sequence[LiveConnection], meshcat: int | None) -> list[Watcher]:
    """Return the viewers of a run's ground truth: Foxglove, and Meshcat at a port.

    Raises:
        InputError: the port is not available.
    """
    found = [
        cast("Watcher", connection) for connection in connections if hasattr(connection, "sample")
    ]
    return found + meshcat_view(meshcat)


def meshcat_view(port: int | None) -> list[Watcher]:
    """Return Drake's Meshcat at a port; empty without a port.

    Raises:
        InputError: the port is not available.
    """
    if port is None:
        return []
    from crowdbot.core.sim.meshcat_view import MeshcatView

    view = MeshcatView(port)
    _say(f"meshcat: {view.url}")
    return [view]


def _services(session: LiveSession) -> dict[str, Service]:
    """Return all services that clients can call."""
    from crowdbot.core.live.services import services
    from crowdbot.core.live.simulation_interfaces import simulation_services

    return {**services(session), **simulation_services(session)}


def needs(extra: str, *modules: str) -> None:
    """Check that the libraries of an optional extra are installed.

    Raises:
        MissingLibraryError: one of them is not.
    """
    from importlib.util import find_spec

    missing = [m for m in modules if find_spec(m) is None]
    if missing:
        raise MissingLibraryError(
            f"{', '.join(missing)}: not installed; install it with pip install 'crowdbot[{extra}]'"
        )


def report(record: RunRecord) -> None:
    """Print on stderr the facts that only a live run has, such as missed steps."""
    live = record.live
    if live is None:
        return
    lag = "" if live.largest_lag is None else f", at most {live.largest_lag:.3g} s behind"
    _say(
        f"live: {live.steps} steps, {live.missed_steps} without a new command in time, "
        f"{live.refused_commands} commands refused{lag}"
    )


def _say(text: str) -> None:
    say(text, err=True)
