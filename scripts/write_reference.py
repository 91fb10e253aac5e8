"""The pages of fields: docs/reference/scenario.md, and docs/reference/components by component.

They are made from the models; scripts/generate.py writes them.
"""

from __future__ import annotations

import os
import re
import types
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, SerializeAsAny
from pydantic.fields import FieldInfo

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.dsl.spec.areas import Area
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.spec.component_specs import CATEGORIES, FloorContact
from crowdbot.dsl.spec.parameters import (
    AccelerationSample,
    DurationSample,
    LengthSample,
    MassSample,
    Sample,
    SpeedDistribution,
    SpeedSample,
)
from crowdbot.dsl.spec.quantities import UNITS, Quantity
from crowdbot.dsl.spec.spec import ComponentSpec, Mount, Range, Rectangle, TiltableMount
from crowdbot.dsl.suite.documents import ScenarioDocument, Seeds, SuiteDocument, SuiteHead

PAGE = Path(__file__).parent.parent / "docs" / "reference" / "scenario.md"
FOLDER = PAGE.parent / "components"

_WRITTEN = "<!-- Written by make generate: change the models, not this page. -->"
_HEAD = f"""\
# Scenarios and suites: every field

{_WRITTEN}

A *scenario* holds everything the robot meets; the planner is never part of it. A *suite* expands
to a list of scenarios; [Change a scenario](../howto/change_a_scenario.md) shows one. What each
error means is on the page [errors](errors.md). The fields of planners are on
[planners](planners.md), those of metrics on their pages in [metrics](metrics.md).
`crowdbot plugins show KIND` prints the fields of any component that is installed.

Pages of their own: {{components}}.

A quantity is a number in the unit of its column, or text with a unit of the same dimension, such
as `80 cm/s`. World frame: x along the corridor, y left, z up, angles counter-clockwise.
"""
_TREE = """\
```{toctree}
:hidden:
:glob:
components/*
```
"""
_COMPONENTS = ("environment", "crowd policy", "cost function", "robot", "sensor", "noise")
_DRAWS = (LengthSample, SpeedSample, AccelerationSample, MassSample, DurationSample)
_SHARED = (
    Asset,
    Mount,
    TiltableMount,
    FloorContact,
    Range,
    Rectangle,
    Area,
    SpeedDistribution,
    *_DRAWS,
)
#: Fields that a document's reader checks; the models do not know their types.
_READ = {
    "matrix": "map of maps of maps",
    "only": "map or list of maps",
    "exclude": "map or list of maps",
    "kinds": "map of integer",
}
_EXTENDS = (
    "| `extends` | text or list of text |  | empty | Files laid under this map, left to right: "
    "relative to this file, not outside the folder of the document, or `NAME:path` in a plugin's "
    "folder. |"
)
_NAMES = {float: "number", int: "integer", str: "text", bool: "true or false", Any: "anything"}
_BOUNDS = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}


def pages() -> dict[Path, str]:
    """Return file -> text of all pages of fields."""
    registry = discover(allow=())
    found = {FOLDER / "crowd.md": _page("The crowd of a scenario", _crowd(registry))}
    for category in _COMPONENTS:
        title = _plural(category).capitalize()
        found[page_of(category)] = _page(title, _components(registry, category))
    names = sorted(found, key=lambda p: p.stem)
    listed = ", ".join(f"[{_name(p)}](components/{p.name})" for p in names)
    parts = [_HEAD.format(components=listed), _units(), *_documents(), *_scenario(registry)]
    found[PAGE] = _joined([*parts, *_shared(), _TREE])
    return {path: linked(text, path) for path, text in found.items()}


def _name(page: Path) -> str:
    return page.stem.replace("_", " ")


def _page(title: str, parts: Iterator[str]) -> str:
    about = "Units and parts that several components share are on [scenarios](../scenario.md).\n"
    return _joined([f"# {title}: every field\n", f"{_WRITTEN}\n", about, *parts])


def _joined(parts: list[str]) -> str:
    return "\n".join(parts).rstrip() + "\n"


def page_of(category: str) -> Path:
    """Return the page of the components of a category."""
    return FOLDER / f"{_plural(category).replace(' ', '_')}.md"


def linked(text: str, page: Path) -> str:
    """Return text in which links to parts and components, ``(#name)``, lead from a page to them."""
    shared = {f"(#{m.__name__.lower()})": PAGE for m in _SHARED}
    whole = {f"(#{_plural(c).replace(' ', '-')})": page_of(c) for c in _COMPONENTS}
    for anchor, home in [*shared.items(), *whole.items()]:
        where = os.path.relpath(home, page.parent)
        place = anchor[1:-1] if anchor in shared else ""
        text = text.replace(anchor, anchor if home == page and place else f"({where}{place})")
    return text


def _units() -> str:
    rows = [f"| {dimension} | {', '.join(units)} |" for dimension, units in UNITS.items()]
    head = ["## Units", "", "The first unit of each dimension is that of a bare number.", ""]
    return "\n".join([*head, "| dimension | units |", "|---|---|", *rows, ""])


def _documents() -> Iterator[str]:
    yield _section("## A suite document", SuiteDocument, extends=True)
    yield _section("### suite", SuiteHead)
    yield _section("### seeds", Seeds)
    yield _section("## A scenario document", ScenarioDocument, extends=True)


def _scenario(registry: Registry) -> Iterator[str]:
    yield _section("## A scenario", registry.scenario_model, extends=True)
    yield from _sections(registry, crowd=False)


def _crowd(registry: Registry) -> Iterator[str]:
    yield from _sections(registry, crowd=True)


def _sections(registry: Registry, *, crowd: bool) -> Iterator[str]:
    """Yield the sections of what is nested in a scenario: of its crowd, or of all else."""
    level = "##" if crowd else "###"  # the crowd has a page of its own
    for path, model in _nested(registry.scenario_model, ""):
        if (path.partition(".")[0] == "crowd") != crowd:
            continue
        kinds = _kinds_of(model)
        if not kinds:
            yield _section(f"{level} {path}", model)
            continue
        yield f"{level} {path}\n\n{_prose(model)}\n"
        for kind in kinds:
            name = kind.model_fields["kind"].default
            usual = ", where none is named" if name == vars(model)["usual"] else ""
            yield _section(f"{level}# {path}: {name}", kind, f"`kind: {name}`{usual}.")


def _kinds_of(model: Any) -> list[Any]:
    """The models that a choice between them stands for; none for a plain model."""
    return _concrete(model) if "usual" in vars(model) else []


def _concrete(model: Any) -> list[Any]:
    """The models at the end of a tree of classes, in the order of their definition."""
    below = model.__subclasses__()
    return [leaf for child in below for leaf in _concrete(child)] if below else [model]


def _components(registry: Registry, category: str) -> Iterator[str]:
    for kind, component in registry.components(category).items():
        about = f"`kind: {kind}`, {component.summary}."
        yield _section(f"## {kind}", component.spec, about)
        for path, model in _nested(component.spec, "") if category == "environment" else ():
            yield _section(f"### {kind}: {path}", model)


def _plural(category: str) -> str:
    return f"{category[:-1]}ies" if category.endswith("y") else f"{category}s"


def _shared() -> Iterator[str]:
    yield "## Shared parts\n"
    for model in _SHARED:
        yield _section(f"### {model.__name__.lower()}", model)


def _nested(model: type[BaseModel], prefix: str) -> Iterator[tuple[str, type[BaseModel]]]:
    """Plain models below a model, with the path at which they are written."""
    for name, info in model.model_fields.items():
        inner, named = _model_of(info.annotation)
        if info.exclude or inner is None or issubclass(inner, ComponentSpec) or inner in _SHARED:
            continue
        inner = next((base for base in inner.__mro__ if "usual" in vars(base)), inner)
        path = f"{prefix}{name}.NAME" if named else f"{prefix}{name}"
        yield path, inner
        below = [b for kind in _kinds_of(inner) or [inner] for b in _nested(kind, f"{path}.")]
        yield from dict(below).items()


def _model_of(annotation: Any) -> tuple[type[BaseModel] | None, bool]:
    """The model inside an annotation, and whether it is a member of a map."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation, False
    named = get_origin(annotation) in (dict, Mapping)
    for part in get_args(annotation)[1 if named else 0 :]:
        inner, deeper = _model_of(part)
        if inner is not None:
            return inner, named or deeper
    return None, False


def _section(
    heading: str, model: type[BaseModel], about: str = "", *, extends: bool = False
) -> str:
    lines = [heading, "", *([about, ""] if about else []), _prose(model), "", field_table(model)]
    return "\n".join([*lines, *([_EXTENDS] if extends else []), ""])


def field_table(model: type[BaseModel]) -> str:
    """Return the table of a model's fields, without ``kind``."""
    rows = [_row(n, i) for n, i in model.model_fields.items() if n != "kind" and not i.exclude]
    return "\n".join(
        ["| field | type | unit | default | meaning |", "|---|---|---|---|---|", *rows]
    )


def _prose(model: type[BaseModel]) -> str:
    """A model's docstring; that of the base class for a narrowed one."""
    text = next(c.__doc__ for c in model.__mro__ if "__doc__" in vars(c) and c.__doc__)
    return re.sub(r"\s*\n\s*", " ", text.strip()).replace("``", "`")


def _row(name: str, info: FieldInfo) -> str:
    unit = ", ".join(units_of(info.annotation, info.metadata))
    kind = _READ.get(name, "anything") if _word(info.annotation) == "anything" else _type(info)
    cells = [f"`{name}`", kind, unit, default_of(info), info.description or _about(info)]
    return "| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |"


def _about(info: FieldInfo) -> str:
    """The first sentence of a part's own docstring, for a field without a description."""
    inner, _ = _model_of(info.annotation)
    if inner is None:
        return ""
    base = next((c for c in CATEGORIES if issubclass(inner, c)), inner)
    text = _prose(base).removeprefix("Abstract: ")
    return re.split(r"[.:](?:\s|$)", text[0].upper() + text[1:])[0] + "."


def units_of(annotation: Any, metadata: Any) -> list[str]:
    """Return the SI unit of a field, or those of its parts."""
    found = [m.si_unit for m in metadata if isinstance(m, Quantity)]
    if found or get_origin(annotation) not in (tuple, Annotated, Union, types.UnionType):
        return found
    inner = [a for a in get_args(annotation) if get_origin(a) is Annotated]
    return [u for a in inner for u in units_of(get_args(a)[0], get_args(a)[1:])]


def _type(info: FieldInfo) -> str:
    words, bounds = _word(info.annotation), []
    for item in info.metadata:
        for bound, sign in _BOUNDS.items():
            if hasattr(item, bound):
                bounds.append(f"{sign} {getattr(item, bound)}")
        if isinstance(pattern := getattr(item, "pattern", None), str):
            bounds.append(f"matching `{pattern}`")
    return " ".join([words, ", ".join(sorted(bounds, reverse=True))]).strip()


def _word(annotation: Any) -> str:
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return " or ".join(f"`{a}`" for a in arguments)
    if origin in (Union, types.UnionType):
        words = list(dict.fromkeys(_word(a) for a in arguments if a is not type(None)))
        return " or ".join([*words, *(["`null`"] if type(None) in arguments else [])])
    if origin is Annotated or origin is SerializeAsAny:
        return _word(arguments[0])
    if origin in (dict, Mapping):
        inner = _word(arguments[1])
        return "map" if arguments[1] is Any else f"map of {'maps' if inner == 'map' else inner}"
    if origin in (list, tuple):
        counted = [_word(a) for a in arguments if a is not Ellipsis]
        return "list of " + (", ".join(counted) if len(set(counted)) > 1 else _many(arguments))
    if isinstance(annotation, type) and issubclass(annotation, ComponentSpec):
        return f"[{annotation.category}](#{_plural(annotation.category).replace(' ', '-')})"
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        name = annotation.__name__.lower()
        return f"[{name}](#{name})" if annotation in _SHARED else "map"
    return _NAMES.get(annotation, "anything")


def _many(arguments: tuple[Any, ...]) -> str:
    count = "" if Ellipsis in arguments or len(arguments) == 1 else f"{len(arguments)} × "
    word = _word(arguments[0])
    return f"{count}{'maps' if word == 'map' else word}"


def default_of(info: FieldInfo) -> str:
    """Return what a field is if it is left out, in words."""
    if info.is_required():
        return "required"
    value = info.default
    if isinstance(value, Sample):
        return f"{value.value:.6g}"
    if isinstance(value, BaseModel):
        return "its defaults"
    if value is None:
        return "`null`"
    if isinstance(value, str):
        return f"`{value}`" if value else "empty"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple | dict):
        return f"`[{', '.join(map(str, value))}]`" if value else "empty"
    return f"{value:.6g}"
