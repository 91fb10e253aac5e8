"""Appearance of a crowd's people to sensors."""

from __future__ import annotations

from dataclasses import dataclass

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Appearance:
    """Bodies of people as sensors see them; for contacts they are discs.

    Attributes:
        height: (N,) m; 0: the crowd's default.
        leg_length: (N,) length from the floor to the hip, m; 0: the default share of the height.
        phase: (N,) of the legs at the start, rad.
        look: names of each person's appearance (`crowdbot.dsl.scenario.people_kinds`); "": an
            adult.
    """

    height: Array
    leg_length: Array
    phase: Array
    look: tuple[str, ...]
