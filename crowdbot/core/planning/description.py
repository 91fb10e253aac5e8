"""A planner's description by its class or spec."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast, get_args

from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.support.source_digest import declared_data
from crowdbot.dsl.spec.component_specs import PlannerRole, PlannerSpec
from crowdbot.errors import InputError, did_you_mean, nearest


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerDescription:
    """Facts about a planner that must be known before it runs.

    Attributes:
        needs: sensors it reads, by name or category; None: all.
        privileged: True if it may read data that no real sensor measures.
        role: its role in a benchmark.
        runtime: its runtime, if it is not crowdbot's Python.
        data: names or patterns of files that it reads, beside it.
    """

    needs: tuple[str, ...] | None = None
    privileged: bool = False
    role: PlannerRole = "candidate"
    runtime: str = ""
    data: tuple[str, ...] = ()


def described(holder: type, call: PluginCall) -> PlannerDescription:
    """Return the description given by a class.

    Raises:
        InputError: there is no such role.
        PluginError: reading it raises; the class is the one that ``call`` raises.
    """
    with call("what it says of itself"):
        needs = getattr(holder, "needs", None)
        return PlannerDescription(
            needs=None if needs is None else tuple(str(n) for n in needs),
            privileged=getattr(holder, "privileged", False) is True,
            role=role_of(holder),
            data=declared_data(holder),
        )


def sensors_of(needs: tuple[str, ...] | None, spec: PlannerSpec) -> tuple[str, ...] | None:
    """Return the sensors that a planner with a spec reads: those it needs, and optional ones."""
    return None if needs is None else (*needs, *(f"{want}?" for want in spec.wants))


def read_description(message: Mapping[str, Any], planner: str) -> PlannerDescription:
    """Check the description sent by a planner process, which may be malformed.

    Raises:
        InputError: it is not a valid description.
    """
    needs, runtime = message.get("needs"), message.get("runtime", "")
    if needs is not None and not (isinstance(needs, list) and all(map(_is_name, needs))):
        raise InputError(f"{planner}: hello: 'needs' is a list of names of sensors, or nil")
    if not isinstance(runtime, str):
        raise InputError(f"{planner}: hello: 'runtime' is text")
    data = message.get("data", [])
    if not (isinstance(data, list) and all(map(_is_name, data))):
        raise InputError(f"{planner}: hello: 'data' is a list of names of files")
    return PlannerDescription(
        needs=None if needs is None else tuple(needs),
        privileged=message.get("privileged", False) is True,
        role=_role(message.get("role", "candidate"), planner),
        runtime=runtime[:80],
        data=tuple(data),
    )


def role_of(holder: type) -> PlannerRole:
    """Return the role that a planner class or spec declares.

    Raises:
        InputError: there is no such role.
    """
    return _role(getattr(holder, "role", "candidate"), f"planner '{holder.__name__}'")


def _role(role: object, planner: str) -> PlannerRole:
    known = get_args(PlannerRole)
    if role not in known:
        near = did_you_mean(nearest(str(role), known)) or f"; there are {', '.join(known)}"
        raise InputError(f"{planner}: no role '{role}'{near}")
    return cast(PlannerRole, role)


def _is_name(value: object) -> bool:
    return isinstance(value, str) and bool(value)
