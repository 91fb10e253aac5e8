"""Scoring of contact forces, from the contact table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.plugin import (
    ContactEvents,
    Mask,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)
from crowdbot.plugins.metrics.contact import (
    CONTACT_IMPULSE,
    CONTACT_TIME,
    MAX_CONTACT_FORCE,
    ContactImpulseSpec,
    ContactTimeSpec,
    MaxContactForceSpec,
)


@dataclass(frozen=True, slots=True)
class MaxContactForce:
    """Scores ``max_contact_force``. Needs a table of contacts; 0 without contact."""

    spec: MaxContactForceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the largest force peak of all contacts with people."""
        del refs
        factory = ScoreFactory(MAX_CONTACT_FORCE)
        found = _with_people(factory, run)
        if isinstance(found, list):
            return found
        contacts, rows = found
        return [factory.ok("corrected", contacts.peak_force[rows].max(initial=0.0))]


@dataclass(frozen=True, slots=True)
class ContactImpulse:
    """Scores ``contact_impulse``. Needs a table of contacts; 0 without contact."""

    spec: ContactImpulseSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the sum over all contacts with people, and the ``largest`` impulse."""
        del refs
        factory = ScoreFactory(CONTACT_IMPULSE)
        found = _with_people(factory, run)
        if isinstance(found, list):
            return found
        contacts, rows = found
        impulses = contacts.impulse[rows]
        largest = {"largest": float(impulses.max(initial=0.0))}
        return [factory.ok("corrected", impulses.sum(), largest)]


@dataclass(frozen=True, slots=True)
class ContactTime:
    """Scores ``contact_time``. Needs a table of contacts; 0 without contact."""

    spec: ContactTimeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the total contact time with people; two simultaneous contacts count twice."""
        del refs
        factory = ScoreFactory(CONTACT_TIME)
        found = _with_people(factory, run)
        if isinstance(found, list):
            return found
        contacts, rows = found
        return [factory.ok("corrected", (contacts.t1 - contacts.t0)[rows].sum())]


def _with_people(
    factory: ScoreFactory, run: Trajectories
) -> tuple[ContactEvents, Mask] | list[Score]:
    """Return contacts up to the arrival and a mask of those with people; or why there are none."""
    if run.robot is None:
        return factory.all_undefined("invalid_no_robot")
    contacts = truncate_at_arrival(run).contacts
    if contacts is None:
        return factory.all_undefined("invalid_no_contacts")
    return contacts, contacts.agent >= 0
