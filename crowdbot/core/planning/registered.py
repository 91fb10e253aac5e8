"""Registered planners: their spec from a kind and parameters, and building them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from crowdbot.core.planning.half import HalfPlanner
from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.python_file import checked_planner
from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import PlannerSpec
from crowdbot.errors import (
    CrowdbotError,
    InputError,
    PlannerError,
    UnknownNameError,
    did_you_mean,
    nearest,
)


def find_kind(kind: str, registry: Registry, where: str = "") -> Component[Any]:
    """Return the component of a kind.

    Args:
        where: start of the message.

    Raises:
        UnknownNameError: no planner of that kind is installed.
    """
    try:
        return registry.find("planner", kind)
    except UnknownNameError as error:
        known, why = registry.components("planner"), registry.why_absent(kind)
        raise UnknownNameError(f"{where}planner", kind, known, why) from error


def spec_of_kind(
    component: Component[Any], parameters: Mapping[str, Any], where: str = ""
) -> PlannerSpec:
    """Return the spec of a planner with some parameters.

    Raises:
        InputError: a parameter is wrong.
        PluginError: a validator raised an unexpected error.
    """
    call = PluginCall(f"planner '{component.kind}'", passes=(CrowdbotError, ValidationError))
    try:
        with call("its parameters cannot be read"):
            spec: PlannerSpec = component.spec.model_validate(
                {**parameters, "kind": component.kind}
            )
    except ValidationError as error:
        known = component.spec.model_fields
        raise InputError("\n".join(_lines(error, component.kind, known, where))) from None
    return spec


def load_kind(kind: str, parameters: Mapping[str, Any], registry: Registry) -> PlannerSpec:
    """Return the spec of a planner and import its code.

    Raises:
        PluginError: it cannot be imported.
    """
    component = find_kind(kind, registry)
    spec = spec_of_kind(component, parameters)
    load_build(component, registry.plugin_call(spec))
    return spec


def build_of_kind(spec: PlannerSpec, registry: Registry, half: Planner | None = None) -> Planner:
    """Build a planner from a spec.

    Args:
        half: the planner that it uses, if it uses one; default: built of its spec.

    Raises:
        PlannerError: it cannot be made, or lacks a method.
    """
    call = registry.plugin_call(spec, error=PlannerError, passes=PlannerError)
    halves = half_of(spec, registry) if half is None else (half,)
    return registry.build(spec, checked_planner, *halves, call=call)


def half_of(spec: PlannerSpec, registry: Registry) -> tuple[Planner, ...]:
    """Build the planner that another planner calls, in this process; empty without one.

    Raises:
        InputError: it is not a registered kind, or a parameter is wrong.
        PlannerError: it cannot be made.
    """
    if not uses_half(spec):
        return ()
    half = half_spec(spec, registry)
    planner = build_of_kind(half, registry)
    needs = getattr(half, "needs", None)
    return (HalfPlanner(planner, half.kind, needs, privileged=is_privileged(half)),)


def half_spec(spec: PlannerSpec, registry: Registry, where: str = "") -> PlannerSpec:
    """Return the spec of the registered planner that a planner calls.

    Raises:
        InputError: it is not a registered kind, or a parameter is wrong.
    """
    half, where = getattr(spec, spec.half), f"{where}{spec.half}: "
    if not isinstance(half, Mapping) or not isinstance(half.get("kind"), str):
        raise InputError(f"{where}'{spec.kind}' runs in a process of its own; name a kind here")
    parameters = {name: value for name, value in half.items() if name != "kind"}
    return spec_of_kind(find_kind(half["kind"], registry, where), parameters, where)


def uses_half(spec: PlannerSpec) -> bool:
    """Return True if a planner calls another one."""
    return bool(spec.half) and getattr(spec, spec.half) is not None


def is_privileged(holder: object) -> bool:
    """Return True if a planner class or spec is privileged, by class variable or field."""
    return getattr(holder, "privileged", False) is True


def _lines(error: ValidationError, kind: str, known: Mapping[str, Any], where: str) -> list[str]:
    lines = []
    for item in error.errors(include_url=False):
        field = ".".join(str(part) for part in item["loc"])
        if item["type"] == "extra_forbidden":
            near = did_you_mean(nearest(field, known))
            lines.append(f"{where}planner '{kind}' has no parameter '{field}'{near}")
        else:
            name = f"{field}: " if field else ""
            lines.append(f"{where}planner '{kind}': {name}{item['msg']}")
    return lines
