"""Times of a bag's messages: header stamps or recording times, common clock, clock resets."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.bag.columns import Columns
from crowdbot.errors import InputError

Times = NDArray[np.int64]
#: A simulator's clock begins at 0; stamps before this are not since 1970, s.
_SIMULATED = 1e8
#: A stamp this much before the one recorded before it is a reset, s.
_RESET = 1.0
#: Delays of two topics that differ by more are told, s; by more, clocks differ.
_DELAY, _CLOCKS = 0.5, 5.0


def filled(stamp: Times, log: Times) -> Times:
    """Return stamps (K,), ns, with missing ones estimated; all 0 if there are none.

    The first stamp of a simulator may be 0. Another 0 is replaced by the recording time minus the
    delay of the other messages.
    """
    missing = stamp == 0
    if missing.all() or not missing.any():
        return stamp
    known = stamp[~missing]
    at_start = np.array_equal(missing, np.logical_and.accumulate(missing))
    if at_start and known[0] <= min(_SIMULATED * 1e9, 2 * _step(log) + 10**9):
        return stamp
    delay = np.median(log[~missing] - known)
    return np.where(missing, log - np.int64(delay), stamp)


def _step(log: Times) -> float:
    return float(np.median(np.diff(np.unique(log)))) if len(np.unique(log)) > 1 else 0.0


def parts(stamp: Times) -> NDArray[np.int64]:
    """Return the number (K,) of resets of the clock before each message, in order of recording."""
    back = np.diff(stamp) < -_RESET * 1e9
    return np.concatenate([[0], np.cumsum(back)]).astype(np.int64)


def longest_part(path: Path, topics: Mapping[str, Columns], notes: list[str]) -> dict[str, Columns]:
    """Return the rows of topics in the longest period between two resets of the clock.

    Raises:
        InputError: the clocks of two topics are reset, and not equally often.
    """
    numbers = {topic: parts(columns.stamp) for topic, columns in topics.items() if len(columns)}
    counts = {topic: int(number.max()) for topic, number in numbers.items()}
    if not any(counts.values()):
        return dict(topics)
    topic = max(counts, key=lambda name: counts[name])
    if set(counts.values()) - {0, counts[topic]}:
        seen = ", ".join(f"that of {name} {count} times" for name, count in sorted(counts.items()))
        raise InputError(
            f"{path}: the clock of a topic goes back by more than {_RESET:g} s: {seen}; cut the "
            "bag where it was reset"
        )
    again = topics[topic].log[np.flatnonzero(np.diff(numbers[topic])) + 1]
    for name in (name for name, count in counts.items() if not count):
        numbers[name] = np.searchsorted(again, topics[name].log, side="right")
    chosen = int(np.argmax(np.bincount(numbers[topic])))
    at = [round(topics[topic].stamp[i] / 1e9, 3) for i in np.flatnonzero(np.diff(numbers[topic]))]
    notes.append(
        f"the clock of {topic} goes back after {', '.join(f'{t:g} s' for t in at)}: the longest "
        f"of {counts[topic] + 1} parts is read, number {chosen + 1}"
    )
    return {t: c.only(numbers[t] == chosen) if t in numbers else c for t, c in topics.items()}


def tell_disorder(topics: Mapping[str, Columns], notes: list[str]) -> None:
    """Add a note where stamps go back from one message to the next; rows are sorted by stamp."""
    for topic, columns in topics.items():
        back = np.diff(columns.stamp[np.diff(columns.message, prepend=-1) > 0])
        if count := np.count_nonzero(back < 0):
            notes.append(
                f"stamps of {topic} go back {count} times, by up to {-back.min() / 1e9:.3g} s: "
                "its messages are sorted by stamp"
            )


def common_clock(robot: Columns, people: Columns, notes: list[str]) -> bool:
    """Return True if the stamps of two topics share a clock; else use recording times.

    The delays between stamps and recording are compared at equal recording times.
    """
    with_stamps = [bool(c.stamp.any()) for c in (robot, people)]
    if not any(with_stamps):
        return False
    order = np.argsort(robot.log, kind="stable")
    delays = [
        (c.log - c.stamp) / 1e9 if has else np.zeros(len(c))
        for c, has in zip((robot, people), with_stamps, strict=True)
    ]
    begin, end = max(robot.log.min(), people.log.min()), min(robot.log.max(), people.log.max())
    there = (people.log >= begin) & (people.log <= end)
    if not there.any():
        return True
    at_robot = np.interp(people.log[there], robot.log[order], delays[0][order])
    differs = float(np.median(delays[1][there] - at_robot))
    if abs(differs) <= _DELAY:
        return True
    if abs(differs) > _CLOCKS or not all(with_stamps):
        notes.append(
            f"stamps of the robot and of people are of two clocks, {abs(differs):.3g} s apart; "
            "times of recording are taken"
        )
        return False
    notes.append(
        f"people are recorded {differs:.3g} s later after their stamps than the robot: a slow "
        f"detector, or two clocks? clock_offset={differs:.3g} would correct the latter"
    )
    return True
