"""Orders of conditions, counterbalanced over participants; and order files."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from crowdbot.core.studies.document import Study, StudyTrial
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.dsl.scenario.seeds import stream_seed


def latin_square(n: int) -> list[list[int]]:
    """Return the cyclic square: each of n conditions once in each row and in each place."""
    return [[(row + k) % n for k in range(n)] for row in range(n)]


def williams(n: int) -> list[list[int]]:
    """Return rows of conditions in which each condition follows each other one equally often.

    Williams, Australian Journal of Scientific Research A 2, 1949: n rows for even n, 2 n for odd,
    of which the second half are the first ones backwards.
    """
    zigzag = [(k + 1) // 2 if k % 2 else -(k // 2) for k in range(n)]
    rows = [[(row + step) % n for step in zigzag] for row in range(n)]
    return rows if n % 2 == 0 else rows + [row[::-1] for row in rows]


def condition_order(study: Study, participant: str) -> list[str]:
    """Return the labels of conditions in the order of a participant."""
    labels = list(study.spec.conditions)
    rows = _square(study.spec.order, len(labels))
    row = rows[study.spec.people.index(participant) % len(rows)]
    return [labels[k] for k in row]


def _square(order: str, n: int) -> list[list[int]]:
    """Return the rows of an order method; each is a permutation of 0 to n - 1."""
    if order == "fixed":
        return [list(range(n))]
    return williams(n) if order == "williams" else latin_square(n)


def trial_order(study: Study, participant: str, condition: str) -> list[tuple[int, StudyTrial]]:
    """Return the trials of a participant in a condition, in order.

    Each has its number in the document, from 1 on.
    """
    trials = list(enumerate(study.spec.trials, start=1))
    if study.spec.trial_order == "drawn":
        key = f"{study.spec.id}\0{participant}\0{condition}"
        seed = stream_seed(study.spec.seed, key, "study.trials")
        random.Random(seed).shuffle(trials)  # noqa: S311 - the same order in each process
    return trials


def balance(orders: Sequence[Sequence[str]]) -> tuple[int, int]:
    """Return how unbalanced orders are: spreads of the counts of positions, and of successions.

    0 means that each condition is equally often at each position, or after each other one.
    """
    labels = sorted({label for order in orders for label in order})
    places = [
        sum(order[k] == label for order in orders) for label in labels for k in range(len(labels))
    ]
    after = [
        sum(pair == (a, b) for order in orders for pair in pairwise(order))
        for a in labels
        for b in labels
        if a != b
    ]
    return max(places) - min(places), max(after, default=0) - min(after, default=0)


def write_order_files(study: Study, folder: Path) -> list[Path]:
    """Write one order file for each participant, as the original's ``FileOrder{USER}.csv``.

    Each line is a trial: condition and scenario.

    Raises:
        InputError: a file cannot be written.
    """
    written = []
    for participant in study.spec.people:
        lines = [
            f"{condition}/{trial.suite}/{trial.scenario}\n"
            for condition in condition_order(study, participant)
            for _, trial in trial_order(study, participant, condition)
        ]
        written.append(folder / f"FileOrder{participant}.csv")
        atomic_write(written[-1], "".join(lines))
    return written
