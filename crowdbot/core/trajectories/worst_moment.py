"""The most interesting moment of a run."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from crowdbot.core.trajectories.encounters import encounter
from crowdbot.core.trajectories.fault.at_fault import at_fault
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.person_contacts import person_contacts
from crowdbot.core.trajectories.preprocess import truncate_at_arrival
from crowdbot.core.trajectories.trajectories import Trajectories

#: Defaults of the metric ``contacts_at_fault``; m, m, m/s. The tolerance of its speed covers
#: rounding.
CONTACT_TOL, RELEASE_GAP, JUMP_SPEED = 1e-9, 0.05, 10.0
RULE = FaultRule(speed=0.05 + 1e-9, reaction=0.3, braking=1.0, margin=0.1)

What = Literal["contact at fault", "least clearance"]


class WorstMoment(NamedTuple):
    """Time, event, and distance of the nearest person.

    ``t``: s, on the run's clock. ``clearance``: gap between surfaces, m; 0 or less in contact, None
    if unknown.
    """

    t: float
    what: What
    clearance: float | None


def worst_moment(run: Trajectories) -> WorstMoment | None:
    """Return the first contact that the robot caused, else the smallest clearance.

    The first contact at fault is shown because later ones often follow from it. Otherwise the
    nearest approach is shown, which includes a person walking into the robot.

    Returns:
        None for a run without robot or people.
    """
    if run.robot is None or run.agents is None:
        return None
    run = truncate_at_arrival(run)
    contacts = person_contacts(run, JUMP_SPEED, CONTACT_TOL, RELEASE_GAP)
    gaps = encounter(run, JUMP_SPEED).gap
    fault = at_fault(run, contacts, RULE, JUMP_SPEED)
    if fault.any():
        first = int(np.argmin(np.where(fault, contacts.time, np.inf)))
        sample, agent = int(contacts.sample[first]), int(contacts.agent[first])
        gap = float(gaps[sample, agent]) if agent >= 0 else np.nan
        clearance = min(gap, 0.0) if np.isfinite(gap) else None
        return WorstMoment(float(contacts.time[first]), "contact at fault", clearance)
    if not np.isfinite(gaps).any():
        return None
    sample = int(np.nanargmin(gaps) // gaps.shape[1])
    return WorstMoment(float(run.t[sample]), "least clearance", float(np.nanmin(gaps)))
