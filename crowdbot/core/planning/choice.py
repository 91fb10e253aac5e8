"""A chosen planner, and where it runs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

from crowdbot.core.planning.containment.offer import Aspect, kernel_offer
from crowdbot.core.support.json_digest import digest
from crowdbot.dsl.spec.component_specs import PlannerRole

if TYPE_CHECKING:
    from crowdbot.core.planning.planner import Planner

#: Names of the planner's place in records.
OWN: Final = "own"
IN_PROCESS: Final = "in_process"
#: Largest address space of a planner's own process, bytes.
MEMORY = 4 << 30


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerPlace:
    """The process in which a planner runs.

    Attributes:
        in_process: True: in the simulator's process; False: in a separate process; None: built-in
            planners inside, all others separate.
        memory: largest address space of a separate process, bytes; None: unlimited.
        contained: True to refuse planners that this system cannot contain.
        lenient: True to accept a planner that cannot be loaded in its process; it fails in every
            run, and a campaign continues with the others.
        kept: folder of files that planners read, each named by its SHA-256; None: none.
        sealed: folder of a sealed planner, which may declare nothing outside of it, nor ask for the
            network; None: it is not sealed.
    """

    in_process: bool | None = None
    memory: int | None = MEMORY
    lenient: bool = False
    contained: bool = False
    kept: Path | None = None
    sealed: Path | None = None

    def own_memory(self, in_process: bool) -> int | None:
        """Return the memory limit, if there is a separate process."""
        return None if in_process else self.memory


ANYWHERE = PlannerPlace()


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerChoice:
    """A planner chosen by the user, which can be built any number of times.

    Attributes:
        name: its kind or class name.
        spec_dump: everything that defines it, as JSON values.
        build: builds a new one; raises `PlannerError` or `PluginError`.
        pinned: True if it comes from an installed distribution.
        needs: sensors it reads, by name or category; None: all.
        label: ``name``, with ``+`` and four hex digits when parameters are not the defaults, and
            ``+privileged`` if privileged; used in scores.
        privileged: True if it may read data that no real sensor measures.
        role: floor, baseline, ceiling or candidate. A planner with changed parameters is a
            candidate.
        origin: its distribution or file.
        in_process: True if it runs in the simulator's process, without isolation.
        memory: limit of its separate process, bytes; None: unlimited.
        repeatable: True if the same choice gives the same run; False for an existing object, whose
            runs are never reused.
        patience: s after which a step in this process counts as hung; None: default.
        fleet: the planner of each robot, if they differ.
        files: SHA-256 -> file that it reads, such as weights.
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
    files: Mapping[str, Path] = field(default_factory=dict)

    @property
    def digest(self) -> str:
        """Return the SHA-256 of the planner's code; of its parameters if the code is installed."""
        own = self.spec_dump.get("sha256") or digest(self.spec_dump)
        return str(own).rpartition(":")[2]

    def of(self, robot: str) -> PlannerChoice:
        """Return the planner of one robot."""
        return self.fleet.get(robot, self)

    @property
    def all_files(self) -> dict[str, Path]:
        """Return SHA-256 -> file for all files that the planner, or each one of a fleet, reads."""
        files = dict(self.files)
        for choice in self.fleet.values():
            files |= choice.files
        return files

    @property
    def died(self) -> str:
        """Return how its process, or one of its fleet's, died on loading; empty if it did not.

        Such a choice fails in every run, and the planner's description is unknown; a new attempt
        may succeed.
        """
        found = (getattr(choice.build, "died", "") for choice in (self, *self.fleet.values()))
        return next(filter(None, found), "")

    @property
    def contained(self) -> list[Aspect] | None:
        """Return the accesses that the kernel denies the planner; None in this process."""
        return None if self.in_process else list(kernel_offer().contained)

    @property
    def process(self) -> Literal["own", "in_process"]:
        """Return the process in which the planner runs, as named in records."""
        return IN_PROCESS if self.in_process else OWN


def _nothing_to_drive() -> Planner:
    raise AssertionError("a run of people alone has no planner")


#: The choice of runs without a robot.
NO_ROBOT = PlannerChoice(
    name="no_robot",
    spec_dump={"kind": "no_robot"},
    build=_nothing_to_drive,
    pinned=True,
    needs=(),
    label="no_robot",
    role="floor",
)


def label_of(name: str, parameters: Mapping[str, Any], privileged: bool) -> str:
    """Return the name of the folder with a planner's runs.

    Args:
        parameters: parameters that differ from the defaults.
    """
    label = f"{name}+{_digest(parameters)}" if parameters else name
    return f"{label}+privileged" if privileged else label


def _digest(parameters: Mapping[str, Any]) -> str:
    """Return four hex digits."""
    text = json.dumps(dict(parameters), sort_keys=True, separators=(",", ":"), default=repr)
    return hashlib.sha256(text.encode()).hexdigest()[:4]
