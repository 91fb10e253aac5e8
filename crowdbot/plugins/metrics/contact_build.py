"""Scoring of contact forces, from the contact table."""

from __future__ import annotations

from collections.abc import Sequence

import crowdbot.plugins.metrics.contact as specs
from crowdbot.plugin import ContactEvents, Mask, References, Score, Trajectories
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError


class MaxContactForce(RobotMetric[specs.MaxContactForceSpec]):
    """Scores ``max_contact_force``: the largest force peak of all contacts with people.

    Needs a table of contacts; 0 without contact.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        contacts, rows = _with_people(run)
        return [self.factory.ok("corrected", contacts.peak_force[rows].max(initial=0.0))]


class ContactImpulse(RobotMetric[specs.ContactImpulseSpec]):
    """Scores ``contact_impulse``: the sum over contacts with people, and the ``largest``.

    Needs a table of contacts; 0 without contact.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        contacts, rows = _with_people(run)
        impulses = contacts.impulse[rows]
        largest = {"largest": float(impulses.max(initial=0.0))}
        return [self.factory.ok("corrected", impulses.sum(), largest)]


class ContactTime(RobotMetric[specs.ContactTimeSpec]):
    """Scores ``contact_time``: total contact time; two simultaneous contacts count twice.

    Needs a table of contacts; 0 without contact.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        contacts, rows = _with_people(run)
        return [self.factory.ok("corrected", (contacts.t1 - contacts.t0)[rows].sum())]


def _with_people(run: Trajectories) -> tuple[ContactEvents, Mask]:
    """Return contacts and a mask of those with people; raise `UndefinedError` without a table."""
    contacts = run.contacts
    if contacts is None:
        raise UndefinedError("invalid_no_contacts")
    return contacts, contacts.agent >= 0
