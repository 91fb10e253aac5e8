"""Where planners come from: a registered kind, a YAML file, or a class in a Python file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast, get_args

from pydantic import ValidationError
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.python_file import (
    check_parameters,
    guess_class,
    missing_methods,
    planner_class,
)
from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.source_digest import source_digest
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.component import Component
from crowdbot.dsl.component_specs import PlannerRole, PlannerSpec
from crowdbot.errors import InputError, PlannerError, UnknownNameError, did_you_mean, nearest


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannerChoice:
    """A planner that can be built any number of times.

    Attributes:
        name: its kind, or the class' name.
        spec_dump: everything that defines it, as JSON values.
        build: makes a new one; raises `PlannerError` or `PluginError`.
        pinned: whether it comes from an installed distribution.
        needs: sensors it reads, by name or category; None asks for all.
        label: ``name``, with ``+`` and four hex digits when parameters are not the defaults, and
            with ``+privileged`` where that holds: scores carry it.
        privileged: whether it may read what no sensor of a real robot could tell.
        role: what it is there for: floor, baseline, ceiling or candidate. One with other
            parameters than its defaults is a candidate.
        origin: the distribution, or the file, that it comes from.
        repeatable: whether the same choice makes the same run; False for an object that was made
            already, whose runs are never reused.
    """

    name: str
    spec_dump: dict[str, Any]
    build: Callable[[], Planner]
    pinned: bool
    needs: tuple[str, ...] | None
    label: str
    privileged: bool = False
    role: PlannerRole = "candidate"
    origin: str = ""
    repeatable: bool = True


def resolve_planner(text: str, registry: Registry, settings: Sequence[str] = ()) -> PlannerChoice:
    """Find a planner and check its parameters, without building it.

    Args:
        text: a kind (``dwa``), a YAML file with ``kind`` and parameters, or ``file.py:Class``.
        registry: the installed components.
        settings: ``key=value``, values in YAML; they come after those of a file.

    Raises:
        UnknownNameError: no planner of that kind is installed.
        InputError: a file, class or parameter is wrong.
        PlannerError: the Python file cannot be imported.
    """
    given = setting_values(settings)
    path, colon, name = text.rpartition(":")
    if colon and path.endswith(".py"):
        return _from_class(Path(path), name, given)
    if text.endswith(".py"):
        raise InputError(f"{text}: which class? Write {text}:{guess_class(Path(text))}")
    if colon and Path(f"{path}.py").is_file():
        raise InputError(f"{text}: no such file; did you mean {path}.py:{name}?")
    if text.endswith((".yaml", ".yml")) or "/" in text:
        document = _read(Path(text))
        kind = document.pop("kind", None)
        if not isinstance(kind, str):
            raise InputError(f"{text}: 'kind' is missing: which planner is it?")
        return _from_kind(kind, {**document, **given}, registry, f"{text}: ")
    return _from_kind(text, given, registry, "")


def kinds_of_role(role: PlannerRole, registry: Registry) -> list[str]:
    """Planners that are installed for some purpose and need no parameter, in alphabetical order."""
    return sorted(
        kind
        for kind, component in registry.components("planner").items()
        if role_of(component.spec) == role
        and not component.experimental
        and _has_defaults(component)
    )


def select_sensors(
    needs: Sequence[str] | None,
    sensors: Mapping[str, SensorInfo],
    planner: str,
    *,
    privileged: bool = False,
) -> tuple[str, ...]:
    """Names of the sensors that a planner gets, in the robot's order.

    Args:
        needs: names or categories; None is all that it may have.
        sensors: what the robot has.
        planner: for the message.
        privileged: whether it may have privileged sensors.

    Raises:
        InputError: the robot has nothing that answers to a need, or only something privileged.
    """
    if needs is None:
        return tuple(n for n, s in sensors.items() if privileged or not s.privileged)
    offered = {*sensors, *(s.category for s in sensors.values())}
    for need in needs:
        if need not in offered:
            has = ", ".join(sorted(offered)) or "none"
            raise InputError(f"planner '{planner}' needs '{need}'; the robot's sensors: {has}")
    found = tuple(n for n, s in sensors.items() if n in needs or s.category in needs)
    for name in found:
        if sensors[name].privileged and not privileged:
            raise InputError(
                f"planner '{planner}' needs '{name}', which is privileged: "
                "a planner that reads it must say 'privileged = True'"
            )
    return found


# ------------------------------------------------------------------ registered kinds
def _from_kind(
    kind: str, parameters: Mapping[str, Any], registry: Registry, where: str
) -> PlannerChoice:
    try:
        component = registry.find("planner", kind)
    except UnknownNameError as error:
        known, why = registry.components("planner"), registry.why_absent(kind)
        raise UnknownNameError(f"{where}planner", kind, known, why) from error
    spec = _validated(component, parameters, where)
    # Imported at once, so that one that cannot be is refused before a run begins.
    load_build(component, registry.plugin_call(spec))
    owner = registry.owner(component)
    as_given = _is_default(component, spec)

    def build() -> Planner:
        call = registry.plugin_call(spec, error=PlannerError, passes=PlannerError)
        return registry.build(spec, checked_planner, call=call)

    return PlannerChoice(
        name=kind,
        spec_dump=spec.model_dump(mode="json"),
        build=build,
        pinned=owner.pinned,
        origin=owner.distribution,
        needs=_needs(component.spec),
        label=_label(kind if as_given else f"{kind}+{_digest(spec)}", spec),
        privileged=_is_privileged(spec),
        role=role_of(component.spec) if as_given else "candidate",
    )


def _validated(component: Component[Any], parameters: Mapping[str, Any], where: str) -> PlannerSpec:
    try:
        spec: PlannerSpec = component.spec.model_validate({**parameters, "kind": component.kind})
    except ValidationError as error:
        known = component.spec.model_fields
        raise InputError("\n".join(_lines(error, component.kind, known, where))) from None
    return spec


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


def _is_default(component: Component[Any], spec: PlannerSpec) -> bool:
    try:
        return bool(component.spec.model_validate({"kind": component.kind}) == spec)
    except ValidationError:  # some parameter has no default
        return False


def _has_defaults(component: Component[Any]) -> bool:
    return not any(f.is_required() for f in component.spec.model_fields.values())


def _digest(value: Any) -> str:
    """Four hex digits of some parameters."""
    dump = value.model_dump(mode="json") if isinstance(value, PlannerSpec) else value
    text = json.dumps(dump, sort_keys=True, separators=(",", ":"), default=repr)
    return hashlib.sha256(text.encode()).hexdigest()[:4]


def _needs(holder: type) -> tuple[str, ...] | None:
    needs = getattr(holder, "needs", None)
    return None if needs is None else tuple(str(n) for n in needs)


def _is_privileged(holder: object) -> bool:
    """Whether a planner class, or a spec, in a class variable or a field, says so."""
    return getattr(holder, "privileged", False) is True


def role_of(holder: type) -> PlannerRole:
    """What a planner class, or a spec, says that it is there for.

    Raises:
        InputError: there is no such role.
    """
    role = getattr(holder, "role", "candidate")
    if role not in get_args(PlannerRole):
        known = get_args(PlannerRole)
        near = did_you_mean(nearest(str(role), known)) or f"; there are {', '.join(known)}"
        raise InputError(f"planner '{holder.__name__}': no role '{role}'{near}")
    return cast(PlannerRole, role)


def _label(label: str, holder: object) -> str:
    return f"{label}+privileged" if _is_privileged(holder) else label


# ------------------------------------------------------------------------ documents
def setting_values(settings: Sequence[str] | Mapping[str, Any]) -> dict[str, Any]:
    """Parameters by name.

    Args:
        settings: ``key=value`` texts, values in YAML; or the mapping itself.

    Raises:
        InputError: a text is not ``key=value``.
    """
    if isinstance(settings, Mapping):
        return dict(settings)
    values: dict[str, Any] = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals or not key.strip():
            raise InputError(f"'{setting}' is not a setting; write key=value")
        try:
            values[key.strip()] = YAML(typ="safe", pure=True).load(value)
        except YAMLError as error:
            raise InputError(f"'{setting}': the value is not YAML: {_first(error)}") from None
    return values


def _read(path: Path) -> dict[str, Any]:
    try:
        document = YAML(typ="safe", pure=True).load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {_reason(error)}") from None
    except YAMLError as error:
        raise InputError(f"{path}: not valid YAML: {_first(error)}") from None
    if not isinstance(document, dict) or not all(isinstance(k, str) for k in document):
        raise InputError(f"{path}: a planner is a mapping with 'kind' and parameters")
    return document


def _reason(error: OSError | UnicodeDecodeError) -> str:
    return str(getattr(error, "strerror", None) or error)


def _first(error: YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or str(error).splitlines()[0]
    return f"line {mark.line + 1}: {problem}" if mark is not None else str(problem)


# --------------------------------------------------------------------- Python files
def _from_class(path: Path, name: str, parameters: Mapping[str, Any]) -> PlannerChoice:
    kind = planner_class(path, name)
    check_parameters(kind, parameters, f"{path}:{name}")
    return choice_of_class(kind, parameters, str(path), source_digest(path), name)


def choice_of_class(
    kind: type[Any], parameters: Mapping[str, Any], origin: str, digest: str, name: str = ""
) -> PlannerChoice:
    """The choice of a class that nobody registered.

    Args:
        kind: the class, with ``reset`` and ``step``.
        parameters: checked ones, for its constructor.
        origin: the file, or the module and name, where it is written.
        digest: of what is written there.
        name: what it is called there; by default its own name.
    """
    name = name or kind.__name__
    file = origin.endswith(".py")
    dump = {
        "kind": f"{Path(origin).name}:{name}" if file else origin,
        "sha256": digest,
        **({"parameters": dict(parameters)} if parameters else {}),
    }

    def build() -> Planner:
        call = PluginCall(
            f"planner '{name}' ({origin})",
            sources=lambda: {str(Path(origin).resolve())} if file else set(),
            error=PlannerError,
            passes=PlannerError,
        )
        with call("cannot be built"):
            return checked_planner(kind(**parameters))

    return PlannerChoice(
        name=name,
        spec_dump=dump,
        build=build,
        pinned=False,
        origin=origin,
        needs=_needs(kind),
        label=_label(f"{name}+{_digest(dict(parameters))}" if parameters else name, kind),
        privileged=_is_privileged(kind),
        role="candidate" if parameters else role_of(kind),
    )


def checked_planner(planner: object) -> Planner:
    """A planner, as far as that can be seen before it is called.

    Raises:
        PlannerError: it lacks a method.
    """
    missing = missing_methods(planner)
    if missing:
        what = type(planner).__name__
        raise PlannerError(f"what was built, a {what}, has no {' and no '.join(missing)}")
    return cast(Planner, planner)
