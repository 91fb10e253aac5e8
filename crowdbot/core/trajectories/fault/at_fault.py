"""The rule if a contact is the robot's fault; docs/reference/fault.md shows each case."""

from __future__ import annotations

from crowdbot.core.trajectories.fault.braking import FaultRule, braked_in_time
from crowdbot.core.trajectories.fault.cutting_in import cut_in
from crowdbot.core.trajectories.fault.pushing_on import pushed_on
from crowdbot.core.trajectories.fault.shoved import shoved_into
from crowdbot.core.trajectories.fault.swerving import swerved
from crowdbot.core.trajectories.person_contacts import PersonContacts
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Mask


def at_fault(
    run: Trajectories, contacts: PersonContacts, rule: FaultRule, jump_speed: float
) -> Mask:
    """Return a mask of contacts (K,) that the robot causes.

    It moved towards the person with the touching point although it could have braked, it hit the
    person by a turn or a start, it kept pushing during the contact, or it cut in before a faster
    person; not if it stood still and another person pushed it into this one. If the direction or
    the person is unknown, a moving robot is at fault.

    Args:
        run: the run of ``contacts``.
        contacts: from `person_contacts`.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    key = "at_fault", rule, jump_speed, contacts.recorded, len(contacts)
    return run.cached(key, lambda: _at_fault(run, contacts, rule, jump_speed))


def _at_fault(
    run: Trajectories, contacts: PersonContacts, rule: FaultRule, jump_speed: float
) -> Mask:
    braked = braked_in_time(run, rule, contacts.time, contacts.sample, contacts.agent, jump_speed)
    driven = ~(contacts.closing <= rule.speed) & ~braked
    pushed = pushed_on(run, contacts, rule, jump_speed)
    came = swerved(run, contacts, rule, jump_speed)
    moved = (driven | came) & ~shoved_into(run, contacts, rule, jump_speed)
    return moved | pushed | cut_in(run, contacts, rule, jump_speed)
