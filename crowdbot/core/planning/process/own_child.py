"""A planner's process in crowdbot's own Python.

It is forked from `fork_server` and contains nothing of the simulator: everything about the run
comes through the connection.
"""

from __future__ import annotations

import faulthandler
import io
import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgpack

from crowdbot.core.planning.drawn import DrawnRows
from crowdbot.core.planning.guarded import GuardedPlanner, planner_title
from crowdbot.core.planning.planner import (
    NoValidCommand,
    Observation,
    Planner,
    Truth,
    named_drawing,
    named_signal,
)
from crowdbot.core.planning.process import serving
from crowdbot.core.planning.python_file import (
    build_of_class,
    call_of_class,
    check_parameters,
    planner_class,
)
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.person_task import PersonEstimate, PersonTask
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import Pinhole, Reading, SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import CrowdbotError, InputError, printable
from crowdbot.old_names import collected_old_names

_TYPES = SimpleNamespace(
    Task=Task, Pose=Pose, RobotBody=RobotBody, RobotLimits=RobotLimits, SensorInfo=SensorInfo,
    Pinhole=Pinhole, Reading=Reading, Observation=Observation, Truth=Truth,
    PersonTask=PersonTask, PersonEstimate=PersonEstimate,
)  # fmt: skip


#: Longest error text that the simulator keeps, characters.
_LONGEST_TEXT = 10_000
#: A planner's description, its call boundary, and its builder.
_Found = tuple[type, PluginCall, Callable[[], Planner]]


class OwnSide:
    """One planner in crowdbot's Python: finds, builds and calls it.

    Args:
        what: ``name`` and ``origin`` for messages; ``file`` and ``class``, or ``kind`` and where
            plugins are found; ``parameters``.
    """

    def __init__(self, order: Mapping[str, Any]) -> None:
        self._order = order
        self._decoder = serving.Decoder(_TYPES, serving.numpy_array)
        self._build: Callable[[], Planner] | None = None
        self._guarded: GuardedPlanner | None = None
        self._signals: list[tuple[str, float]] = []
        self._drawings: list[list[Any]] = []

    def hello(self, sent: Mapping[str, Any]) -> dict[str, Any]:
        """Find the planner and return its description."""
        del sent
        find = self._file if "file" in self._order else self._kind
        with collected_old_names() as old_names:
            holder, call, self._build = find()
        with call("what it says of itself"):
            description = serving.described(holder)
        return {
            "type": "hello",
            "protocol": serving.PROTOCOL,
            "arrays": "shared",
            "old_names": old_names,
            **description,
        }

    def reset(self, sent: Mapping[str, Any]) -> dict[str, Any]:
        """Build the planner and reset it."""
        assert self._build is not None
        self._decoder.open_memory(sent["memory"])
        title = planner_title(self._order["name"], self._order["origin"])
        with collected_old_names() as old_names:
            self._guarded = GuardedPlanner(self._build(), title)
        decode = self._decoder
        self._guarded.reset(
            decode.task(sent["task"]),
            decode.limits(sent["limits"]),
            decode.sensors(sent["sensors"]),
            sent["seed"],
        )
        return {"type": "ready", "old_names": old_names}

    def observe(self, sent: dict[str, Any]) -> dict[str, Any]:
        """Run one step."""
        assert self._guarded is not None
        self._signals, self._drawings = [], []
        obs = self._decoder.observation(sent, self._log, self._draw)
        v, w, vy = self._guarded.step(obs)
        return {
            "type": "command",
            "v": v,
            "w": w,
            "vy": vy,
            "signals": self._signals,
            "drawings": self._drawings,
        }

    def error(self, error: BaseException) -> dict[str, Any]:
        """Convert an exception to a message."""
        signals, self._signals = self._signals, []
        if isinstance(error, NoValidCommand):
            return {"type": "stop", "signals": signals}
        known = isinstance(error, CrowdbotError)
        text = str(error) if known else f"{type(error).__name__}: {error}"
        text = printable(text[:_LONGEST_TEXT])
        kind = "input" if isinstance(error, InputError) else "planner"
        return {"type": "error", "text": text, "kind": kind, "whole": known, "signals": signals}

    def _log(self, name: str, value: float) -> None:
        self._signals.append(named_signal(name, value))

    def _draw(self, name: str, rows: DrawnRows, /, text: str | Sequence[str] | None = None) -> None:
        name, table, texts = named_drawing(name, rows, text)
        labels = () if texts is None else (list(texts),)
        self._drawings.append([name, table.tolist(), *labels])

    def _file(self) -> _Found:
        path, name = Path(self._order["file"]), self._order["class"]
        parameters = self._order["parameters"]
        kind = planner_class(path, name)
        check_parameters(kind, parameters, f"{path}:{name}")
        build = partial(build_of_class, kind, parameters, path, name)
        return kind, call_of_class(path, name), build

    def _kind(self) -> _Found:
        from crowdbot.core.planning.registered import build_of_kind, load_kind  # slow imports
        from crowdbot.core.registry.registry import discover
        from crowdbot.core.registry.registry_source import RegistrySource

        where: RegistrySource = self._order["plugins"]
        registry = discover(extra=where.extra, allow=where.allow, entry_points=where.entry_points)
        spec = load_kind(self._order["kind"], self._order["parameters"], registry)
        return type(spec), registry.plugin_call(spec), partial(build_of_kind, spec, registry)


def main(order: Mapping[str, Any]) -> None:
    """Serve one planner until the simulator closes the connection."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stdout = sys.__stdout__ = _stream(1)  # type: ignore[misc]
    sys.stderr = sys.__stderr__ = _stream(2)  # type: ignore[misc]
    faulthandler.enable()
    serving.serve(serving.Line(msgpack.packb, msgpack.unpackb), OwnSide(order))


def _stream(descriptor: int) -> io.TextIOWrapper:
    """Return a line-buffered text stream, also if the descriptor is a pipe."""
    return open(descriptor, "w", buffering=1, encoding="utf-8", errors="replace", closefd=False)
