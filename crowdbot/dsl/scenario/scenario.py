"""Scenario: the complete explicit environment of a robot, without a planner.

The classes here are typed with abstract component specs. `crowdbot.core.registry.registry` narrows
them to the installed components; the base classes refuse to validate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from annotated_types import Le
from pydantic import Field, PrivateAttr, SerializeAsAny, field_validator

from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.spec.body_regions import BodyRegion
from crowdbot.dsl.spec.component_specs import EnvironmentSpec
from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import NonNegativeDamping, PositiveFrequency, PositiveStiffness
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.text.path_names import PathName


class Contact(Spec):
    """Compliance between robot and pedestrians: Hunt-Crossley, F = k d (1 + c d')."""

    stiffness: Annotated[PositiveStiffness, BodyRegion()] = default(
        30000.0, "k, N/m, or a body region whose value it takes, such as lower_leg."
    )
    dissipation: Annotated[NonNegativeDamping, Le(1)] = default(
        0.3, "c, s/m. With more than 1, steps of 1/128 s throw light robots away."
    )


class Rates(Spec):
    """Rates of events; powers of two, so that Drake's events coincide exactly."""

    crowd: PositiveFrequency = default(16.0, "Decisions of the crowd, Hz.")
    planner: PositiveFrequency = default(16.0, "Steps of the planner, Hz.")
    log: PositiveFrequency = default(16.0, "Samples for metrics, Hz.")

    @field_validator("crowd", "planner", "log")
    @classmethod
    def _dyadic(cls, value: float) -> float:
        if value not in (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0):
            raise ValueError("must be a power of two from 1 to 128 Hz")
        return value


@dataclass(frozen=True, slots=True, eq=False)
class Locked:
    """The lock of a scenario.

    Attributes:
        files: files of the suite's lock.
        origin: function that returns the scenario as in the suite, without ``--set`` and later
            changes.
    """

    files: LockFiles
    origin: Callable[[], Scenario]


class Scenario(Spec):
    """One fully explicit trial. ``id``, ``title`` and ``references`` are outside the hash."""

    id: PathName = Field(
        description="Stable name, unique in its suite.", pattern=r"^[A-Za-z0-9_.+/-]+$"
    )
    title: str = default("", "For people.")
    environment: SerializeAsAny[EnvironmentSpec]
    crowd: Crowd | None = None
    robots: dict[str, Robot] = default({}, "Named robots.")
    contact: Contact = default(Contact(), "Robot against pedestrian.")
    rates: Rates = default(Rates(), "How often things happen.")
    references: Mapping[str, Scenario] = default(
        {}, "Calibration runs, by name.", exclude=True, repr=False
    )
    #: Draws a scenario as HTML, for notebooks; registered by the Python API.
    draw_html: ClassVar[Callable[[Scenario], str] | None] = None

    _locked: Locked | None = PrivateAttr(default=None)  # the lock with its agents
    _hidden: str = PrivateAttr(default="")  # commitment to a seed that is not revealed yet

    def __eq__(self, other: object) -> bool:
        """Return True if the content is equal; the lock is ignored."""
        return isinstance(other, Scenario) and self.__dict__ == other.__dict__

    @property
    def locked(self) -> Locked | None:
        """Return the lock of its agents, if any."""
        return self._locked

    @property
    def hidden(self) -> str:
        """Return the commitment to the seed of its people, until that is revealed; else ""."""
        return self._hidden

    def hide(self, commitment: str) -> None:
        """Mark the seed of its people as hidden."""
        self._hidden = commitment

    def lock_to(self, locked: Locked) -> None:
        """Set the lock of its agents, also for the references."""
        for scenario in (self, *self.references.values()):
            scenario._locked = locked

    def _repr_html_(self) -> str | None:
        """Return a drawing for notebooks; None if no renderer is registered."""
        draw = type(self).draw_html
        return None if draw is None else draw(self)


#: Fields of a scenario that do not affect the simulation.
OUTSIDE_HASH = ("id", "title", "references")
