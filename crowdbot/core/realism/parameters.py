"""Parameters of a crowd to fit, and their bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.errors import InputError, UnknownNameError

#: Parameters that are not fitted: limits of bodies, view distances, contact forces.
_FIXED = (
    "mass", "max_speed", "max_acceleration", "height", "range", "angle", "contact_stiffness",
)  # fmt: skip
_PLACES = ("policy", "costs", "steering", "speed", "body")
_RESPONSE = ("robot_response",)
#: Numbers of a response to robots that are fitted by default: those that encounters depend on most.
_FITTED_RESPONSE = (
    "clearance", "clearance_range", "clearance_growth", "most_clearance", "yield_time", "horizon",
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """A parameter to fit: its path in the scenario, start and bounds.

    Attributes:
        key: path in the scenario, such as ``crowd.costs.way.d_max``.
        start, low, high: in SI units.
    """

    key: str
    start: float
    low: float
    high: float

    def value(self, share: float) -> float:
        """Return the value at a fraction between low and high; geometric if both are above 0."""
        share = min(1.0, max(0.0, share))
        if self.low > 0.0:
            return float(self.low * (self.high / self.low) ** share)
        return self.low + share * (self.high - self.low)

    def share(self, value: float) -> float:
        """Return the fraction between low and high of a value, the inverse of `value`."""
        if self.low > 0.0:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


def parameters_of(
    crowd: Crowd, chosen: Sequence[str] = (), *, robot: bool = False
) -> list[Parameter]:
    """Return the chosen parameters, or all positive ones from half to twice their value.

    Args:
        crowd: the crowd with the parameters.
        robot: take parameters of its response to robots.
        chosen: ``key=low..high`` texts; ``crowd.`` is optional; default bounds: half to twice.

    Raises:
        UnknownNameError: the crowd has no such parameter.
        InputError: the bounds are invalid.
    """
    known = dict(numbers(crowd, _RESPONSE if robot else _PLACES))
    if not chosen:
        kept = _is_fitted_response if robot else _is_free
        keys = [k for k in known if known[k] > 0.0 and kept(k)]
        return [_around(k, known[k]) for k in keys]
    return [_chosen(text, known) for text in chosen]


def numbers(crowd: Crowd, places: Sequence[str] = _PLACES) -> Iterator[tuple[str, float]]:
    """Yield key and value of every number that describes a crowd, in some of its fields."""
    content = crowd.model_dump(mode="json", include=set(places))
    for place in places:
        if isinstance(content.get(place), Mapping):
            yield from _numbers(f"crowd.{place}", content[place])


def overrides_of(parameters: Sequence[Parameter], shares: Array) -> list[str]:
    """Return ``key=value`` texts for a point, in the format of `--set`."""
    return [
        f"{p.key}={p.value(float(share))!r}" for p, share in zip(parameters, shares, strict=True)
    ]


def shares_of(parameters: Sequence[Parameter]) -> Array:
    """Return the fractions of the start values."""
    return np.array([p.share(p.start) for p in parameters])


def _numbers(above: str, content: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    for name, value in content.items():
        if isinstance(value, Mapping):
            yield from _numbers(f"{above}.{name}", value)
        elif isinstance(value, float):
            yield f"{above}.{name}", value


def _is_free(key: str) -> bool:
    return not any(word in _FIXED for word in key.split(".")[1:])


def _is_fitted_response(key: str) -> bool:
    return key.rpartition(".")[2] in _FITTED_RESPONSE


def _around(key: str, value: float) -> Parameter:
    return Parameter(key=key, start=value, low=0.5 * value, high=2.0 * value)


def _chosen(text: str, known: Mapping[str, float]) -> Parameter:
    key, equals, bounds = text.partition("=")
    key = key.strip() if key.startswith("crowd.") else f"crowd.{key.strip()}"
    within = f"crowd.robot_response.{key.removeprefix('crowd.')}"
    key = within if within in known else key
    if key not in known:
        raise UnknownNameError("number of the crowd", key, sorted(known))
    if not equals:
        if known[key] <= 0.0:
            raise InputError(f"--fit {text}: it is 0; give bounds, {text}=LOW..HIGH")
        return _around(key, known[key])
    low, dots, high = bounds.partition("..")
    try:
        ends = float(low), float(high)
    except ValueError:
        ends = math.nan, math.nan
    if not (dots and ends[0] < ends[1] and all(map(math.isfinite, ends))):
        raise InputError(f"--fit {text}: bounds are written LOW..HIGH, in SI units")
    start = min(max(known[key], ends[0]), ends[1])
    return Parameter(key=key, start=start, low=ends[0], high=ends[1])
