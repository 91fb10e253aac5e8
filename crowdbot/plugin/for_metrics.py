"""Tools for metrics' build functions: runs as arrays, encounters, contacts, pairs of runs."""

from __future__ import annotations

from crowdbot.core.trajectories.demanded_evasion import MOST, demanded_evasion, robot_approach
from crowdbot.core.trajectories.disc_around_robot import as_disc
from crowdbot.core.trajectories.dynamic_time_warping import least_warping, spaced
from crowdbot.core.trajectories.encounters import (
    approach,
    contact_events,
    contact_runs,
    encounter,
    people,
    people_speeds,
    people_velocities,
    relative_velocity,
    robot_of,
    robot_velocities,
    touching,
)
from crowdbot.core.trajectories.evasion import Evasion, evasion, ghost_run, own_legs
from crowdbot.core.trajectories.fault.at_fault import at_fault
from crowdbot.core.trajectories.fault.braking import FaultRule
from crowdbot.core.trajectories.fault.driven_aside import driven_aside
from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.headway import share_below
from crowdbot.core.trajectories.paired_people import (
    Effects,
    Pairing,
    meeting_effects,
    whole_effects,
)
from crowdbot.core.trajectories.person_contacts import PersonContacts, person_contacts
from crowdbot.core.trajectories.person_track import PersonStance, person_stance
from crowdbot.core.trajectories.preprocess import (
    heading_changes,
    inf_to_nan,
    present,
    samples_of_shorter,
    truncate_to_shorter,
    valid_agent_steps,
    valid_robot_steps,
    wrap,
)
from crowdbot.core.trajectories.questionnaires import TLX_SCALES, USE_ITEMS, Answer
from crowdbot.core.trajectories.trips import (
    DISTANCE_TOLERANCE,
    Durations,
    MeanPace,
    displacement,
    durations,
    mean_pace,
    meets_robot,
    walked_distances,
)

__all__ = [
    "DISTANCE_TOLERANCE",
    "MOST",
    "TLX_SCALES",
    "USE_ITEMS",
    "Answer",
    "Durations",
    "Effects",
    "Evasion",
    "FaultRule",
    "MeanPace",
    "Pairing",
    "PersonContacts",
    "PersonStance",
    "approach",
    "as_disc",
    "at_fault",
    "contact_events",
    "contact_runs",
    "demanded_evasion",
    "displacement",
    "driven_aside",
    "durations",
    "encounter",
    "evasion",
    "footprint_of",
    "ghost_run",
    "heading_changes",
    "inf_to_nan",
    "least_warping",
    "mean_pace",
    "meeting_effects",
    "meets_robot",
    "own_legs",
    "people",
    "people_speeds",
    "people_velocities",
    "person_contacts",
    "person_stance",
    "present",
    "relative_velocity",
    "robot_approach",
    "robot_of",
    "robot_velocities",
    "samples_of_shorter",
    "share_below",
    "spaced",
    "touching",
    "truncate_to_shorter",
    "valid_agent_steps",
    "valid_robot_steps",
    "walked_distances",
    "whole_effects",
    "wrap",
]
