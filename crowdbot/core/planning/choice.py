"""A planner that was chosen, and where it is to run."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal

from crowdbot.dsl.spec.component_specs import PlannerRole

if TYPE_CHECKING:
    from crowdbot.core.planning.planner import Planner

#: Where a planner runs, as records say it.
OWN: Final = "own"
IN_PROCESS: Final = "in_process"
#: Address space of a planner's own process, bytes.
MEMORY = 4 << 30


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerPlace:
    """Where a planner is to run.

    Attributes:
        in_process: inside the simulator, or in a process of its own; None: crowdbot's own inside,
            all others in a process of their own.
        memory: largest address space of a process of its own, bytes; None sets no limit.
        lenient: whether one that cannot be loaded in its process is a planner all the same, which
            fails in every run: a campaign goes on with the others.
    """

    in_process: bool | None = None
    memory: int | None = MEMORY
    lenient: bool = False

    def own_memory(self, in_process: bool) -> int | None:
        """The limit, where there is a process that has it."""
        return None if in_process else self.memory


ANYWHERE = PlannerPlace()


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerChoice:
    """A planner that can be built any number of times.

    Attributes:
        name: its kind, or the class' name.
        spec_dump: everything that defines it, as JSON values.
        build: makes a new one; raises `PlannerError` or `PluginError`.
        pinned: whether it comes from an installed distribution.
        needs: sensors it reads, by name or category; None asks for all.
        label: ``name``, with ``+`` and four hex digits when parameters are not the defaults, and
            with ``+privileged`` where that holds: scores carry it.
        privileged: whether it may read what no sensor of a real robot could tell.
        role: what it is there for: floor, baseline, ceiling or candidate. One with other
            parameters than its defaults is a candidate.
        origin: the distribution, or the file, that it comes from.
        in_process: whether it runs inside the simulator, where nothing contains it.
        memory: limit of its own process, bytes; None: none.
        repeatable: whether the same choice makes the same run; False for an object that was made
            already, whose runs are never reused.
        patience: s after which a step in this process counts as hung; None: the usual time.
        fleet: the planner of each of several robots, where they have not all the same.
    """

    name: str
    spec_dump: dict[str, Any]
    build: Callable[[], Planner]
    pinned: bool
    needs: tuple[str, ...] | None
    label: str
    privileged: bool = False
    role: PlannerRole = "candidate"
    origin: str = ""
    in_process: bool = True
    memory: int | None = None
    repeatable: bool = True
    patience: float | None = None
    fleet: Mapping[str, PlannerChoice] = field(default_factory=dict)

    def of(self, robot: str) -> PlannerChoice:
        """The planner of one robot."""
        return self.fleet.get(robot, self)

    @property
    def died(self) -> str:
        """How its process, or one of its fleet's, died while it was loaded; empty: it did not.

        Such a choice fails in every run, and nothing is known of what the planner says of itself;
        chosen again, it may well be loaded.
        """
        found = (getattr(choice.build, "died", "") for choice in (self, *self.fleet.values()))
        return next(filter(None, found), "")

    @property
    def process(self) -> Literal["own", "in_process"]:
        """Where it runs, as records say it."""
        return IN_PROCESS if self.in_process else OWN


def label_of(name: str, parameters: Mapping[str, Any], privileged: bool) -> str:
    """Name of a planner's folder.

    Args:
        parameters: all that make it another planner than that of the name alone.
    """
    label = f"{name}+{_digest(parameters)}" if parameters else name
    return f"{label}+privileged" if privileged else label


def _digest(parameters: Mapping[str, Any]) -> str:
    """Four hex digits."""
    text = json.dumps(dict(parameters), sort_keys=True, separators=(",", ":"), default=repr)
    return hashlib.sha256(text.encode()).hexdigest()[:4]
