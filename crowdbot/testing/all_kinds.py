"""Checks for every component, of any category."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from ruamel.yaml import YAML

from crowdbot.core.registry.build_reference import accepted, load_build
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.checks.pydantic_errors import nested_model
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.quantities import UNITS, Quantity
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.dsl.text.plain_yaml import to_yaml
from crowdbot.testing.around import installed

#: Modules that validation must not load.
HEAVY = frozenset({"numba", "numpy", "pydrake"})
#: Words for numbers without a unit.
_WITHOUT_UNIT = (
    "bits", "count", "dimensionless", "factor", "fraction", "number", "per", "probability",
    "ratio", "relatively", "share", "ticks", "weight",
)  # fmt: skip
_UNITS = frozenset(unit.lower() for units in UNITS.values() for unit in units) | {"si"}
#: Basic symbols of compound units: m^2/s^2, W s^2/(kg m^2).
_SYMBOLS = frozenset({"m", "s", "kg", "n", "j", "w", "hz", "rad", "1"})
#: Category -> what its build functions take after the spec and its parts.
_FURTHER = {
    "crowd policy": ("costs", "agents"), "sensor": ("context",),
    "observation": ("context",), "reward": ("context",),
}  # fmt: skip


def check_kind_is_a_name(component: Component[Any]) -> None:
    """``kind`` is a single literal and the default; in a plugin it starts with the plugin's name.

    If this fails, write ``kind: Literal["plugin.name"] = "plugin.name"`` in lower case.
    """
    annotation = component.spec.model_fields["kind"].annotation
    assert get_origin(annotation) is Literal, f"kind is a {annotation}, not a Literal"
    assert len(get_args(annotation)) == 1, "kind has several values"
    assert component.spec.model_fields["kind"].default == component.kind, "kind has another default"
    built_in = component.spec.__module__.startswith("crowdbot.plugins.")
    pattern = "[a-z][a-z0-9_]*" if built_in else r"[a-z][a-z0-9_]*\.[a-z][a-z0-9_]*"
    assert re.fullmatch(pattern, component.kind), f"'{component.kind}' does not match {pattern}"


def check_summary_is_a_line(component: Component[Any]) -> None:
    """The summary is one line, and the spec has a docstring.

    If this fails, give ``Component(summary=...)`` a few words without a line break, and the spec
    class a docstring.
    """
    assert component.summary.strip() == component.summary != "", "no summary"
    assert len(component.summary.splitlines()) == 1, "the summary has several lines"
    assert (component.spec.__doc__ or "").strip(), "the spec has no docstring"
    assert component.spec_version >= 1, "spec_version begins at 1"


def check_examples_validate(component: Component[Any]) -> None:
    """There is an example, and all examples are valid.

    If this fails, correct ``Component(examples=...)``: mappings of field to value without ``kind``.
    """
    assert component.examples, "no example"
    for example in component.examples:
        assert "kind" not in example, "the example repeats 'kind'"
        _example(component, example)


def check_round_trip(component: Component[Any]) -> None:
    """Converting a spec to YAML and back gives the same spec.

    If this fails, a field is changed by validation or cannot be written; look for validators that
    are not idempotent and for types that JSON does not have.
    """
    for example in component.examples:
        spec = _example(component, example)
        text = to_yaml(spec.model_dump(mode="json"))
        again = component.spec.model_validate(YAML(typ="safe", pure=True).load(text))
        assert again == spec, f"{spec!r} came back as {again!r}"


def check_fields_are_described(component: Component[Any]) -> None:
    """Every field has a description, and numbers have a unit.

    If this fails, use a quantity of ``crowdbot.plugin``, or end the description with
    ``, UNIT.``; a number without unit is a "weight", "factor", "fraction", "ratio" or "share".
    """
    for path, field in _fields(component.spec):
        assert (field.description or "").strip(), f"field '{path}' has no description"
        if field.annotation is float:
            assert _has_unit(field), f"field '{path}' has no unit: {field.description!r}"


def check_unknown_field_is_refused(component: Component[Any]) -> None:
    """An unknown field is an error, not ignored.

    If this fails, the spec changed ``model_config``; keep ``extra="forbid"``.
    """
    example = dict(component.examples[0]) if component.examples else {}
    refused: list[str] = []
    try:
        _validated(component, {**example, "no_such_field": 1})
    except ValidationError as error:
        refused = [e["type"] for e in error.errors()]
    assert "extra_forbidden" in refused, "an unknown field was accepted"


def check_build_resolves(component: Component[Any]) -> None:
    """``build`` names a function with its category's signature.

    If this fails, correct ``Component(build="module:function")``, or what the function takes:
    ``build(spec)``; ``build(spec, context)`` of a sensor, ``build(spec, noise, context)`` of one
    that measures distances; ``build(spec, costs, agents)`` of a crowd policy.
    """
    build = load_build(component)
    try:
        signature = inspect.signature(build)
    except ValueError:  # written in C: no signature
        return
    given = ("spec", *accepted(component, build, _given(component)))
    try:
        signature.bind(*given)
    except TypeError as error:
        raise AssertionError(
            f"{component.build} cannot be called as build({', '.join(given)}): {error}"
        ) from error


def _given(component: Component[Any]) -> tuple[str, ...]:
    """Return the names of the build function's arguments after the spec."""
    parts = (component.spec.parts_field,) if component.spec.parts_field else ()
    half = ("half",) if getattr(component.spec, "half", "") else ()  # a planner within a planner
    return (*parts, *_FURTHER.get(component.category, ()), *half)


def check_spec_is_light(component: Component[Any]) -> None:
    """Importing the module of the spec imports neither pydrake nor numba nor numpy.

    If this fails, move computations to the module that ``build`` names.
    """
    module = component.spec.__module__
    if not HEAVY & _loaded_by(*_modules_beside(component)):
        return  # nothing heavy by all specs of the package, so by this one neither
    heavy = sorted(HEAVY & _loaded_by(module))
    assert not heavy, f"import {module} imports {', '.join(heavy)}"


def check_entry_point_yields_it(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """The installed plugin provides the component.

    If this fails, run ``crowdbot plugins``: the distribution is not installed, its entry point in
    the group ``crowdbot`` names another module, or no hook returns the component.
    """
    known = registry or installed()
    found_of = known.components(component.category)
    failed = [f"{p.name}: {p.failure}" for p in known.plugins if p.failure]
    assert component.kind in found_of, (
        f"no installed plugin provides it{'; ' + '; '.join(failed) if failed else ''}"
    )
    found = known.find(component.category, component.kind)
    assert found == component, f"{known.owner(found).distribution} provides another {found.kind}"


def _example(component: Component[Any], example: Any) -> ComponentSpec:
    try:
        return _validated(component, example)
    except ValidationError as error:
        wrong = "; ".join(
            f"{'.'.join(map(str, e['loc'])) or 'the whole'}: {e['msg']}" for e in error.errors()
        )
        raise AssertionError(f"the example {example} is not valid: {wrong}") from error


def _validated(component: Component[Any], example: Any) -> ComponentSpec:
    spec: ComponentSpec = component.spec.model_validate({"kind": component.kind, **example})
    return spec


def _fields(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, FieldInfo]]:
    """Yield dotted name and info of all fields, nested ones included, without the own ``kind``."""
    for name, field in model.model_fields.items():
        if prefix or name != "kind":
            yield prefix + name, field
        inner = nested_model(field.annotation)
        if inner is not None:
            yield from _fields(inner, f"{prefix}{name}.")


def _has_unit(field: FieldInfo) -> bool:
    text = (field.description or "").rstrip(".").lower()
    return (
        any(isinstance(m, Quantity) for m in field.metadata)
        or _is_unit(text.rpartition(", ")[2])
        or any(re.search(rf"\b{word}s?\b", text) for word in _WITHOUT_UNIT)
    )


def _is_unit(text: str) -> bool:
    """Return True if a text is a unit, or a product of powers of units."""
    parts = [p for p in re.split(r"[\s/()]+", text.replace("sqrt", "")) if p]
    powers = [re.fullmatch(r"([a-z]+|1)(\^\d)?", part) for part in parts]
    made = bool(parts) and all(p is not None and p[1] in _SYMBOLS for p in powers)
    return text in _UNITS or made


def _modules_beside(component: Component[Any]) -> list[str]:
    """Return the modules of all installed specs in a component's package, its own included."""
    module = component.spec.__module__
    package = module.partition(".")[0] + "."
    others = (c.spec.__module__ for plugin in installed().plugins for c in plugin.components)
    return sorted({module, *(other for other in others if other.startswith(package))})


@cache
def _loaded_by(*modules: str) -> frozenset[str]:
    """Return all modules loaded after a fresh interpreter imported modules of one package."""
    path = [*sys.path, *_folder_of(modules[0].partition(".")[0])]
    names = ", ".join(modules)
    code = f"import sys; sys.path[:] = {path!r}; import {names}; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"import {names} fails: {done.stderr.strip()}"
    return frozenset(done.stdout.split())


def _folder_of(top: str) -> list[str]:
    """Return the folder from which a top-level module was imported; empty without a file."""
    file = getattr(sys.modules.get(top), "__file__", None)
    if file is None:
        return []
    own = Path(file)
    return [str(own.parent.parent if own.name == "__init__.py" else own.parent)]
