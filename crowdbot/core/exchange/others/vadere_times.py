"""Times at which the sources of Vadere let people in: distributions of the time between spawns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report

_NOTE = "arrivals with the same mean time between them, single persons"
#: Parts of a source that say when people come in.
_NAMES = ("interSpawnTimeDistribution", "distribution", "distributionParameters")
#: Shortest mean time between two spawns, s.
_LEAST = 1e-6
_Numbers = dict[str, list[float]]


@dataclass(frozen=True, slots=True)
class SpawnTimes:
    """The times at which a source spawns.

    Attributes:
        mean: mean time between spawns, s.
        regular: True if all times between them are equal.
        once: time of the only spawn, s; None if there are more.
    """

    mean: float = 1.0
    regular: bool = True
    once: float | None = None


def read_times(source: Item, report: Report) -> SpawnTimes:
    """Return the spawn times of a source, and record which parts of the file gave them.

    Raises:
        SpecError: E402, a parameter is not a number, or is out of bounds.
    """
    wholes = [part for name in _NAMES if (part := source.find(name)) is not None]
    words: list[str] = []
    numbers: _Numbers = {}
    for whole in wholes:
        _read(whole, words, numbers)
    times = _times(" ".join(words).lower(), numbers)
    for whole in wholes:
        report.interpreted(whole, "crowd.streams.arrivals", _NOTE)
    return times


def _read(whole: Item, words: list[str], numbers: _Numbers) -> None:
    """Collect texts, and the numbers that are parameters of known distributions."""
    for part in whole.walk():
        listed = part.parent if part.name.startswith("[") else part
        name = listed.name if listed else ""
        if isinstance(part.value, str) and (part is whole or part.name == "type"):
            words.append(part.text())
            part.used = True
        elif isinstance(part.value, int | float) and name in {*_PARAMETERS, *_NAMES}:
            numbers.setdefault(name, []).append(part.number(0.0))
            part.used = True
        elif name in {*_PARAMETERS, *_NAMES} and part.children:
            part.used = True


#: Parameters of the distributions there.
_PARAMETERS = ("updateFrequency", "mean", "sd", "numberPedsPerSecond", "trials", "p", "values",
               "intervalLength", "spawnsPerInterval", "spawnTime", "spawnFrequency", "xValues",
               "yValues")  # fmt: skip


def _times(words: str, numbers: _Numbers) -> SpawnTimes:
    if "spawnTime" in numbers:
        return SpawnTimes(once=numbers["spawnTime"][0])
    random = any(word in words for word in ("exponential", "poisson", "normal", "binomial"))
    return SpawnTimes(max(_mean(words, numbers), _LEAST), not random)


def _mean(words: str, numbers: _Numbers) -> float:
    """Return the mean time between two spawns, s."""
    if "numberPedsPerSecond" in numbers:
        return 1.0 / max(numbers["numberPedsPerSecond"][0], _LEAST)
    if "trials" in numbers and "p" in numbers:
        return numbers["trials"][0] * numbers["p"][0]
    if "spawnsPerInterval" in numbers:
        spawns = max(_middle(numbers["spawnsPerInterval"]), _LEAST)
        return numbers.get("intervalLength", [1.0])[0] / spawns
    for name in ("updateFrequency", "mean", "spawnFrequency", "values", "distributionParameters"):
        if name in numbers:
            values = numbers[name]
            several = name == "values" or "empirical" in words
            return _middle(values) if several else values[0]
    return 1.0


def _middle(values: Sequence[float]) -> float:
    return sum(values) / len(values)
