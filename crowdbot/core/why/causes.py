"""Causes: one table of events that can decide a run, in the order in which they are tested.

Before them come the endings that say themselves what decided a run: `Ending.happened`.
"""

from __future__ import annotations

from enum import StrEnum

from crowdbot.core.types.ending import COMPLETE, Ending


class Cause(StrEnum):
    """A cause that can decide a run whose ending does not say it; the first that applies counts.

    Attributes:
        past: what such runs did, to follow their number.
        happened: what happened in one; ``{stood}`` is how long the robot stood, s.
    """

    past: str
    happened: str

    def __new__(cls, word: str, past: str, happened: str) -> Cause:  # noqa: D102
        self = str.__new__(cls, word)
        self._value_ = word
        self.past, self.happened = past, happened
        return self

    RAN_INTO = "ran_into_person", "ran into a person, at fault", "the robot ran into a person"
    WALL = "touched_wall", "touched a wall", "the robot touched a wall"
    BLOCKED = (
        "blocked", "stood too long and ran out of time", "the robot stood for {stood:.1f} s"
    )  # fmt: skip
    SLOW = "slow", "were too slow and ran out of time", "the robot moved until time was up"
    ASIDE = (
        "drove_aside", "drove a person aside",
        "the robot drove a person aside, which halves its safe efficiency",
    )  # fmt: skip
    STRUCK = (
        "struck", "arrived, but a person walked into the robot", "a person walked into the robot"
    )  # fmt: skip
    CLOSE = "closest", "arrived without a contact", "the robot was closest to a person"
    ALONE = "met_no_one", "arrived and met no one", "the robot met no one"


#: Everything that can decide a run, the worst first.
DECIDING: tuple[Ending | Cause, ...] = (*(e for e in reversed(COMPLETE) if e.happened), *Cause)
