"""Find planners: a registered kind, a YAML file, or a class in a Python file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from crowdbot.core.planning.choice import ANYWHERE, PlannerChoice, PlannerPlace, label_of
from crowdbot.core.planning.class_choice import class_choice
from crowdbot.core.planning.containment.declared import needs_of_kind
from crowdbot.core.planning.containment.offer import Needs
from crowdbot.core.planning.description import described, role_of, sensors_of
from crowdbot.core.planning.external import external_choice, is_external
from crowdbot.core.planning.files_of_spec import (
    files_of_spec,
    with_absolute_files,
    with_files,
)
from crowdbot.core.planning.fleet_choice import fleet_choice
from crowdbot.core.planning.guarded import planner_title
from crowdbot.core.planning.half_choice import choice_with_half
from crowdbot.core.planning.planner import Planner
from crowdbot.core.planning.policies.policy_name import is_policy
from crowdbot.core.planning.process.describe import describe
from crowdbot.core.planning.process.process_plan import ProcessPlan
from crowdbot.core.planning.python_file import guess_class
from crowdbot.core.planning.registered import (
    build_of_kind,
    find_kind,
    half_spec,
    is_privileged,
    spec_of_kind,
    uses_half,
)
from crowdbot.core.planning.selected_sensors import select_sensors
from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import PlannerRole, PlannerSpec
from crowdbot.dsl.suite.settings import setting_texts
from crowdbot.dsl.text.plain_document import parse_setting, read_document
from crowdbot.errors import InputError

__all__ = ["PlannerChoice", "PlannerPlace", "kinds_of_role", "resolve_planner", "select_sensors"]


def resolve_planner(
    text: str,
    registry: Registry,
    settings: Sequence[str] = (),
    place: PlannerPlace = ANYWHERE,
) -> PlannerChoice:
    """Find a planner and check its parameters, without building it.

    Code of planners in separate processes is not imported here.

    Args:
        text: a kind (``dwa``), a YAML file with ``kind`` and parameters, ``file.py:Class``, or a
            trained policy, ``policy.onnx`` or ``sb3:policy.zip``; for several robots
            ``a=dwa,b=file.py:Class``, or one planner for all.
        registry: the installed components.
        settings: ``key=value``, values in YAML; they override those of a file. For several robots
            ``a.key=value``.
        place: where it runs.

    Raises:
        UnknownNameError: no planner of that kind is installed.
        InputError: a file, class or parameter is wrong.
        PlannerError: the Python file cannot be imported.
    """
    fleet = fleet_choice(text, settings, lambda t, s: resolve_planner(t, registry, s, place))
    if fleet is not None:
        return fleet
    given = setting_values(settings)
    if is_policy(text):
        # Compiled code, which a campaign that has nothing to do does not load.
        from crowdbot.core.planning.policies.policy_choice import policy_choice

        return policy_choice(text, given, registry)
    path, colon, name = text.rpartition(":")
    if colon and path.endswith(".py"):
        return class_choice(Path(path), name, given, place)
    if text.endswith(".py"):
        raise InputError(f"{text}: which class? Write {text}:{guess_class(Path(text))}")
    if colon and Path(f"{path}.py").is_file():
        raise InputError(f"{text}: no such file; did you mean {path}.py:{name}?")
    if text.endswith((".yaml", ".yml")) or "/" in text:
        document = _read(Path(text))
        return _from_document(document, given, registry, _Origin(f"{text}: ", Path(text)), place)
    return _from_kind(text, given, registry, _Origin("", None), place)


def kinds_of_role(role: PlannerRole, registry: Registry) -> list[str]:
    """Return installed planners with a role that need no parameters, in alphabetical order."""
    return sorted(
        kind
        for kind, component in registry.components("planner").items()
        if role_of(component.spec) == role
        and not component.experimental
        and _has_defaults(component)
    )


class _Origin(NamedTuple):
    """The place of a planner's document: start of messages, and the file, if there is one.

    Attributes:
        written: parameters that the document has; files that they name are beside it.
    """

    where: str
    path: Path | None
    written: tuple[str, ...] = ()

    @property
    def folders(self) -> dict[str, Path]:
        """Return the folder of the files that each parameter names."""
        return {} if self.path is None else dict.fromkeys(self.written, self.path.parent)


def _from_document(
    document: Mapping[str, Any],
    given: Mapping[str, Any],
    registry: Registry,
    origin: _Origin,
    place: PlannerPlace,
) -> PlannerChoice:
    """Return the planner of a document; ``given`` overrides its parameters."""
    if is_external(document):
        return external_choice(origin.path or Path("planner.yaml"), document, given, place)
    parameters = {**document, **given}
    kind = parameters.pop("kind", None)
    if not isinstance(kind, str):
        raise InputError(f"{origin.where}'kind' is missing: which planner is it?")
    written = tuple(name for name in document if name not in given)
    return _from_kind(kind, parameters, registry, origin._replace(written=written), place)


# ------------------------------------------------------------------ registered kinds
def _from_kind(
    kind: str,
    parameters: Mapping[str, Any],
    registry: Registry,
    origin: _Origin,
    place: PlannerPlace,
) -> PlannerChoice:
    component = find_kind(kind, registry, origin.where)
    spec = spec_of_kind(component, parameters, origin.where)
    spec = with_files(spec, origin.folders, place.kept)
    files = files_of_spec(spec)
    owner = registry.owner(component)
    in_process = _runs_here(kind, owner, registry, place)
    if uses_half(spec) and owner.name == BUILTIN:
        return choice_with_half(
            spec, component, registry, _half(spec, registry, origin, place), _is_default
        )
    if uses_half(spec):
        half_spec(spec, registry, origin.where)  # it is built in the same process
    description = described(component.spec, registry.plugin_call(spec))
    if in_process:
        # Import it now, so that an import error is reported before a run begins.
        load_build(component, registry.plugin_call(spec))
        build: Callable[[], Planner] = partial(build_of_kind, spec, registry)
    else:
        needs = needs_of_kind(component, registry, files.values())
        _, build = describe(
            _process_of_kind(spec, parameters, registry, needs, place), lenient=place.lenient
        )
    dump, as_given = spec.model_dump(mode="json"), _is_default(component, spec)
    return PlannerChoice(
        name=kind,
        spec_dump=dump,
        build=build,
        pinned=owner.pinned,
        origin=owner.distribution,
        needs=sensors_of(description.needs, spec),
        label=label_of(kind, {} if as_given else dump, is_privileged(spec)),
        privileged=is_privileged(spec),
        role=description.role if as_given else "candidate",
        in_process=in_process,
        memory=place.own_memory(in_process),
        files=files,
    )


def _runs_here(kind: str, owner: Plugin, registry: Registry, place: PlannerPlace) -> bool:
    """Return True if a planner runs in this process.

    Raises:
        InputError: it should run in another one, which does not know its plugin.
    """
    known_elsewhere = registry.source is not None
    if place.in_process is None:
        return owner.name == BUILTIN or not known_elsewhere
    if not place.in_process and not known_elsewhere:
        raise InputError(
            f"planner '{kind}' cannot run in a process of its own: its plugin is known to this "
            "process only"
        )
    return place.in_process


def _process_of_kind(
    spec: PlannerSpec,
    parameters: Mapping[str, Any],
    registry: Registry,
    needs: Needs,
    place: PlannerPlace,
) -> ProcessPlan:
    """Return the process in which a planner of a plugin runs."""
    owner = registry.owner(registry.find("planner", spec.kind))
    return ProcessPlan(
        title=planner_title(spec.kind, owner.distribution),
        own_side={
            "name": spec.kind,
            "origin": owner.distribution,
            "kind": spec.kind,
            "parameters": {**parameters, **with_absolute_files(spec)},
            "plugins": registry.source,
        },
        memory=place.memory,
        contained=place.contained,
        sealed=place.sealed,
        needs=needs,
    )


def _half(
    spec: PlannerSpec, registry: Registry, origin: _Origin, place: PlannerPlace
) -> PlannerChoice:
    """Return the planner that another planner's spec names by document, kind, or file."""
    half = getattr(spec, spec.half)
    where = f"{origin.where}{spec.half}: "
    if isinstance(half, Mapping):
        return _from_document(half, {}, registry, _Origin(where, origin.path), place)
    folder = origin.path.parent if origin.path else Path()
    found = resolve_planner(str(folder / half), registry, (), place)
    if found.fleet:
        raise InputError(f"{where}one planner is wanted, not those of several robots")
    return found


def _is_default(component: Component[Any], spec: PlannerSpec) -> bool:
    try:
        return bool(component.spec.model_validate({"kind": component.kind}) == spec)
    except ValidationError:  # a parameter has no default
        return False


def _has_defaults(component: Component[Any]) -> bool:
    return not any(f.is_required() for f in component.spec.model_fields.values())


# ------------------------------------------------------------------------ documents
def setting_values(settings: Sequence[str] | Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters by name.

    Args:
        settings: ``key=value`` texts, values in YAML; or the mapping itself.

    Raises:
        InputError: a text is not ``key=value``.
    """
    if isinstance(settings, Mapping):
        return dict(settings)
    settings = setting_texts(settings)
    values: dict[str, Any] = {}
    for setting in settings:
        key, equals, _ = setting.partition("=")
        if not equals or not key.strip():
            raise InputError(f"'{setting}' is not a setting; write key=value")
        name, value = parse_setting(setting, "--planner-set")
        values[name] = value
    return values


def _read(path: Path) -> dict[str, Any]:
    document = read_document(path, str(path))
    if not isinstance(document, dict):
        raise InputError(f"{path}: a planner is a mapping with 'kind' and parameters")
    return document
