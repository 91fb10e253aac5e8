"""Convert pydantic's errors to diagnostics, with the position of a key, value or parent map."""

from __future__ import annotations

import inspect
import os
import re
import traceback
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from crowdbot.dsl.text.diagnostics import MAX_ERRORS, Diagnostic, Mark
from crowdbot.dsl.text.merge import kind_of
from crowdbot.dsl.text.nodes import Entry, Node
from crowdbot.errors import PluginError, did_you_mean, nearest

M = TypeVar("M", bound=BaseModel)
Error = Mapping[str, Any]

#: Largest number of fields in a hint.
_FEW = 12
#: Fields that users often misplace, and their correct place.
_ELSEWHERE = {
    "extends": "it stands at the top of a file and where fields of a scenario begin",
    "planner": "it is what you test: crowdbot simulate … --planner NAME",
    "scenario": "a document holds 'suite' and 'base', or one 'scenario'",
}
_RANGE = ("greater_than", "less_than", "finite_number", "multiple_of")
_LENGTH = ("too_short", "too_long")
_TYPES = {
    "float": "a number", "int": "a whole number", "string": "text", "bool": "true or false",
    "model": "a map of fields", "dict": "a map of names", "mapping": "a map of names",
    "tuple": "a list", "list": "a list", "none": "nothing",
}  # fmt: skip


def validate(model: type[M], data: Any, tree: Node) -> tuple[M | None, list[Diagnostic]]:
    """Validate data; errors point into the data's source tree.

    Raises:
        PluginError: a validator raised something other than a validation error.
    """
    try:
        return model.model_validate(data), []
    except ValidationError as error:
        details = _without_echoes(error.errors(include_url=False))[:MAX_ERRORS]
        return None, [diagnose(detail, tree, model) for detail in details]
    except (Exception, SystemExit) as error:
        text = f"a validator of the installed components failed: {type(error).__name__}: {error}"
        raise PluginError(f"{text}{_innermost(error)}") from error


def _innermost(error: BaseException) -> str:
    """Return `` (file:line)`` of the validator that raised."""
    frames = traceback.extract_tb(error.__traceback__)[1:]
    own = [f for f in frames if f"{os.sep}pydantic" not in f.filename and f.filename[0] != "<"]
    return f" ({own[-1].filename}:{own[-1].lineno})" if own else ""


def _without_echoes(details: Sequence[Any]) -> list[Any]:
    """Return errors without those for lists that are too short only because of invalid entries."""
    places = [tuple(detail["loc"]) for detail in details]
    parents = {place[:n] for place in places for n in range(len(place))}
    return [
        d for d, at in zip(details, places, strict=True)
        if d["type"] != "too_short" or at not in parents
    ]  # fmt: skip


@dataclass(frozen=True, slots=True)
class TreePlace:
    """The part of a path that exists in a tree.

    Attributes:
        node: the deepest value on the path.
        entry: the map entry (key and value) of ``node``; None at the root and in lists.
        path: names from the root to ``node``, without discriminator tags.
        rest: the part of the path that the tree lacks.
        types: types that the model allows here.
    """

    node: Node
    entry: Entry | None
    path: tuple[str, ...]
    rest: tuple[str | int, ...]
    types: tuple[Any, ...]

    @property
    def name(self) -> str:
        """Return a readable path."""
        return ".".join(self.path) or "the document"


def locate(tree: Node, loc: Iterable[str | int], model: type[BaseModel] | None = None) -> TreePlace:
    """Follow an error's path as far as the tree has it, without discriminator tags."""
    node, entry, path, rest = tree, None, [], list(loc)
    types: tuple[Any, ...] = (model,) if model else ()
    while rest:
        tag = kind_of(node)
        if tag is None and len(rest) > 1 and _is_usual_kind(types, rest[0]):
            tag = rest[0]  # a kind that is not written
        chosen = rest[0] == tag and (len(rest) > 1 or node.child(rest[0]) is None)
        if chosen or str(rest[0]).startswith("<"):  # a member of a union, not a name
            rest.pop(0)
            continue
        child = node.child(rest[0])
        if child is None:
            break
        types = tuple(t for one in types for t in _step(one, rest[0], tag))
        entry = node.entries.get(str(rest[0]))
        path.append(str(rest.pop(0)))
        node = child
    return TreePlace(node, entry, tuple(path), tuple(rest), types)


def mark_of(tree: Node, *path: str | int) -> Mark:
    """Return the position of a value, or of its nearest parent if it is a default."""
    return locate(tree, path).node.mark


def field_names(place: TreePlace, *, first: bool = False) -> list[str]:
    """Return the fields of all models allowed at a place; with ``first`` of one model only."""
    tag = kind_of(place.node)
    models = [t for t in place.types if _is_model(t) and _has_kind(t, tag)][: 1 if first else None]
    return [n for model in models for n, info in model.model_fields.items() if not info.exclude]


def diagnose(error: Error, tree: Node, model: type[BaseModel]) -> Diagnostic:
    """Convert one pydantic error to a diagnostic."""
    kind, loc = str(error["type"]), tuple(error["loc"])
    if kind == "extra_forbidden":
        return _unknown_field(locate(tree, loc[:-1], model), str(loc[-1]))
    place = locate(tree, loc, model)
    if kind in ("missing", "union_tag_not_found"):
        if isinstance(loc[-1], int):
            count = len(place.node.value) if isinstance(place.node.value, tuple) else 0
            lengths = [len(get_args(t)) for t in place.types if get_origin(t) is tuple]
            text = (
                f"{place.name} has {count} entries, {f'not {lengths[0]}' if lengths else 'too few'}"
            )
            return Diagnostic("E114", text, place.node.mark)
        return missing_field(tree, place, str(loc[-1]) if kind == "missing" else "kind")
    if kind == "union_tag_invalid":
        return _unknown_kind(error, place)
    if kind == "literal_error" and loc[-1] == "kind":
        return _unknown_kind(error, locate(tree, loc[:-1], model))
    code, message, hint = _bad_value(error, kind, place)
    return Diagnostic(code, message, place.node.mark, hint)


def _unknown_field(parent: TreePlace, name: str) -> Diagnostic:
    entry = parent.node.entries.get(name)
    mark = entry.key if entry else parent.node.mark
    others = [known for known in field_names(parent) if known != name]
    hint = did_you_mean(nearest(name, others)[:1]).removeprefix("; ")
    if not hint and 0 < len(others) <= _FEW:
        hint = f"known: {', '.join(others)}"
    if entry and " " in name and entry.node.value is None:
        hint = "inside {} a comma ends a text; quote text that holds one"
    hint = _ELSEWHERE.get(name, hint)
    if name in ("roll", "pitch") and parent.path[-1:] == ("mount",):
        hint = "this sensor has no tilt: only x, y, z and yaw of its mount count"
    hint = _of_another_kind(parent, name) or hint
    where = f" in {parent.name}" if parent.path else ""
    if entry and entry.dotted:
        text = f"'{entry.dotted}' overrides nothing: no field '{name}'{where}"
        return Diagnostic("E204", text, mark, hint)
    return Diagnostic("E102", f"unknown field '{name}'{where}", mark, hint)


def _of_another_kind(parent: TreePlace, name: str) -> str:
    """Return a hint if only another kind than the chosen one has the field; else ""."""
    tag = kind_of(parent.node)
    kinds = [k for t in parent.types if _is_model(t) for k in _kinds(t) if name in t.model_fields]
    usual = next((t.usual for t in parent.types if hasattr(t, "usual")), None)
    chosen = tag or usual
    if usual is None or not kinds or chosen in kinds:
        return ""
    return f"a field of kind '{kinds[0]}', and this is '{chosen}'"


def missing_field(tree: Node, place: TreePlace, name: str) -> Diagnostic:
    """Return the error for a missing field; if an override created its parent, it is named."""
    node = tree
    for depth, key in enumerate(place.path):
        entry, siblings = node.entries.get(key), list(node.entries)
        if entry is None:
            break
        node = entry.node
        if node.implied and entry.dotted:
            near = nearest(key, [s for s in siblings if s != key])
            made = ".".join(place.path[: depth + 1])
            text = f"'{entry.dotted}' overrides nothing: there is no {made}"
            return Diagnostic("E204", text, entry.key, did_you_mean(near).removeprefix("; "))
    where = f" in {place.name}" if place.path else ""
    if name in place.node.removed:
        text = f"missing field '{name}'{where}"
        return Diagnostic("E103", text, place.node.removed[name], "null removes it")
    mark = place.node.mark
    return Diagnostic(
        "E103", f"missing field '{name}'{where}", Mark(mark.source, mark.line, mark.column)
    )


def missing_package(kind: str) -> str:
    """Return a hint for a kind with a plugin's prefix; empty for one without."""
    prefix, dot, _ = kind.partition(".")
    return f"is the package providing '{prefix}' installed?" if dot else ""


def _unknown_kind(error: Error, place: TreePlace) -> Diagnostic:
    kind = place.node.child("kind") or place.node
    context = error["ctx"]
    listed = str(context.get("expected_tags") or context.get("expected"))
    known = [k for k in listed.replace("'", " ").replace(",", " ").split() if k != "or"]
    category = next((t.category for t in place.types if hasattr(t, "category")), "component")
    near = nearest(str(kind.value), known)
    prefix, dot, _ = str(kind.value).partition(".")
    if near:
        hint = did_you_mean(near).removeprefix("; ")
    elif dot and not any(k.startswith(f"{prefix}.") for k in known):
        hint = missing_package(str(kind.value))
    else:
        hint = f"known: {', '.join(known)}"
    return Diagnostic("E120", f"unknown {category} kind '{kind.value}'", kind.mark, hint)


def _bad_value(error: Error, kind: str, place: TreePlace) -> tuple[str, str, str]:
    """Return code, message and hint for an existing but invalid value."""
    given, name, context = _describe(place.node), place.name, error.get("ctx", {})
    text = str(error["msg"]).removeprefix("Value error, ")
    if kind == "quantity":
        dimension = context["dimension"]
        article = "an" if dimension[0] in "aeiou" else "a"
        units = context["units"]
        return (
            "E110",
            f"'{context['text']}' is not {article} {dimension} (known units: {units})",
            str(context.get("hint", "")),
        )
    if kind == "literal_error":
        words = str(context["expected"])
        near = nearest(str(place.node.value), [w.strip("'") for w in words.split()])
        return "E113", f"{name} must be {words}, not {given}", did_you_mean(near).removeprefix("; ")
    if kind.endswith(_LENGTH):
        return "E114", f"{name}: {_lower(text)}", ""
    if kind.startswith(_RANGE):
        return "E112", f"{name}: {_lower(text).replace('input should', 'must')}, not {given}", ""
    if kind == "path_name":
        return "E116", f"{name} {text}", "it is the name of a folder"
    if kind == "string_pattern_mismatch":
        return "E116", f"{name}: {given} {_form(context['pattern'])}", ""
    expected = _TYPES.get(kind.split("_")[0])
    if expected and kind != "value_error":
        scalar = isinstance(place.node.value, int | float)
        hint = (
            "quote it if it is text" if expected == "text" and scalar else _as_map(expected, place)
        )
        return "E111", f"{name} must be {expected}, not {given}", hint
    return "E115", f"{name}: {text}", ""


def _as_map(expected: str, place: TreePlace) -> str:
    """Return a hint on the map that is expected in place of a value; empty if none is."""
    if expected == "a map of names":
        return "write {NAME: …}"
    if expected != "a map of fields":
        return ""
    if any(hasattr(t, "category") for t in place.types):
        return f"write {{kind: {place.node.value if isinstance(place.node.value, str) else '…'}}}"
    # The fields of a union are those of the default kind, since documents need not name that kind.
    names = [name for name in field_names(place, first=True) if name != "kind"]
    return f"its fields: {', '.join(names)}" if 0 < len(names) <= _FEW else ""


def _form(pattern: str) -> str:
    """Return the end of a message on a text that does not match a pattern."""
    found = re.fullmatch(r"\^\[A-Za-z0-9(.+)\]\+\$", pattern)
    if found is None:
        return f"does not match {pattern}"
    return f"may have letters, digits and {' '.join(found[1])} only"


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]


def _describe(node: Node) -> str:
    value = node.value
    if isinstance(value, dict):
        return "a map"
    if isinstance(value, tuple):
        return "a list"
    if isinstance(value, str):
        return f"'{value[:60]}'"
    return "nothing" if value is None else str(value).lower()


def _step(annotation: Any, key: str | int, tag: object) -> list[Any]:
    """Return the types that a type allows under a key; ``tag`` is the ``kind`` of the map."""
    if _is_model(annotation):
        field = annotation.model_fields.get(str(key)) if _has_kind(annotation, tag) else None
        return _flat(field.annotation) if field else []
    arguments = get_args(annotation)
    if get_origin(annotation) in (tuple, list):
        return [t for a in arguments for t in _flat(a)]
    return _flat(arguments[1]) if len(arguments) == 2 else []


def nested_model(annotation: Any) -> type[BaseModel] | None:
    """Return the model of a field that is itself a map of fields, or None."""
    models = [t for t in _flat(annotation) if _is_model(t)]
    return models[0] if len(models) == 1 else None


def _flat(annotation: Any) -> list[Any]:
    """Return the members of a union, with ``Annotated`` removed."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return _flat(get_args(annotation)[0])
    if origin is Union or type(annotation).__name__ == "UnionType":
        return [t for a in get_args(annotation) for t in _flat(a)]
    return [annotation]


def _is_model(annotation: Any) -> bool:
    return inspect.isclass(annotation) and issubclass(annotation, BaseModel)


def _has_kind(model: Any, tag: object) -> bool:
    kinds = _kinds(model)
    return not kinds or tag is None or tag in kinds


def _kinds(model: Any) -> tuple[str, ...]:
    """Return the values that a model allows for ``kind``; empty if they are not fixed."""
    field = model.model_fields.get("kind")
    named = field is not None and get_origin(field.annotation) is Literal
    return get_args(field.annotation) if field is not None and named else ()


def _is_usual_kind(types: Iterable[Any], tag: object) -> bool:
    """Return True if a place accepts several kinds and this is the default one."""
    return any(_is_model(t) and getattr(t, "usual", None) == tag for t in types)
