"""Causes: one table of what can decide a run, in the order in which they are looked for."""

from __future__ import annotations

from enum import StrEnum


class Cause(StrEnum):
    """A cause that can decide a run; the first that applies counts.

    Attributes:
        past: what such runs did, to follow their number.
    """

    past: str

    def __new__(cls, word: str, past: str) -> Cause:  # noqa: D102
        self = str.__new__(cls, word)
        self._value_ = word
        self.past = past
        return self

    PLANNER = "planner", "ended because the planner failed"
    TOPPLED = "toppled", "toppled"
    RAN_INTO = "ran_into_person", "ran into a person, at fault"
    WALL = "touched_wall", "touched a wall"
    BLOCKED = "blocked", "stood too long and ran out of time"
    SLOW = "slow", "were too slow and ran out of time"
    ASIDE = "drove_aside", "drove a person aside"
    STRUCK = "struck", "arrived, but a person walked into the robot"
    CLOSE = "closest", "arrived without a contact"
    ALONE = "met_no_one", "arrived and met no one"
