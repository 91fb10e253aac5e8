"""Write scenes as YAML: one line per list entry; each line has its path in the document."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.exchange.scene import Draft, Path

#: Longest map of scalars on one line, characters.
_WIDE = 100
_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_./+-]*")
_RESERVED = {"true", "false", "null"}


@dataclass(frozen=True, slots=True)
class WrittenLine:
    """One line of a document, its scene, and its path in that scene."""

    text: str
    scene: int = -1
    path: Path = ()


def document(scenes: list[Draft], name: str, title: str = "") -> list[WrittenLine]:
    """Return a scenario document for one scene, else a suite with one label for each."""
    lines = [WrittenLine(f"# {note}") for note in dict.fromkeys(n for s in scenes for n in s.notes)]
    lines.append(WrittenLine("crowdbot: 1"))
    if len(scenes) == 1:
        lines += [WrittenLine("scenario:"), WrittenLine(f"  id: {flow(scenes[0].id)}", 0, ("id",))]
        return lines + list(_scene(scenes[0], 0, 1))
    head = {"id": name, "title": title} if title else {"id": name}
    lines += [
        WrittenLine(f"suite: {flow(head)}"),
        WrittenLine("base: {}"),
        WrittenLine("matrix:"),
        WrittenLine("  trial:"),
    ]
    labels: dict[str, int] = {}
    for number, scene in enumerate(scenes):
        label = re.sub(r"[^A-Za-z0-9_]", "_", scene.id)
        while label in labels:
            label += "_"
        labels[label] = number
        lines.append(WrittenLine(f"    {flow(label)}:", number))
        lines += _scene(scene, number, 3)
    return lines


def _scene(scene: Draft, number: int, depth: int) -> Iterator[WrittenLine]:
    for text, path in _block(scene.data(), depth, (), scene.comments):
        yield WrittenLine(text, number, path)


def _block(
    data: Mapping[str, Any], depth: int, path: Path, comments: Mapping[Path, str]
) -> Iterator[tuple[str, Path]]:
    blank = "  " * depth
    for key, value in data.items():
        here = (*path, key)
        comment = f" # {comments[here]}" if here in comments else ""
        if isinstance(value, list) and value and isinstance(value[0], dict):
            yield f"{blank}{flow(key)}:{comment}", here
            for i, row in enumerate(value):
                place = (*here, str(i))
                note = f" # {comments[place]}" if place in comments else ""
                yield f"{blank}  - {flow(row)}{note}", place
        elif isinstance(value, dict) and value and not _is_leaf(value, here, comments):
            yield f"{blank}{flow(key)}:{comment}", here
            yield from _block(value, depth + 1, here, comments)
        else:
            yield f"{blank}{flow(key)}: {flow(value)}{comment}", here


def _is_leaf(value: dict[str, Any], path: Path, comments: Mapping[Path, str]) -> bool:
    if any(place[: len(path)] == path and len(place) > len(path) for place in comments):
        return False
    parts = list(value.values())
    rows = any(isinstance(p, list) and p and isinstance(p[0], dict) for p in parts)
    return not rows and (not any(isinstance(p, dict) for p in parts) or len(flow(value)) <= _WIDE)


def flow(value: Any) -> str:
    """Return plain data as YAML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{flow(k)}: {flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(flow(v) for v in value) + "]"
    if isinstance(value, bool) or value is None:
        return json.dumps(value)
    if isinstance(value, float):
        return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)
    if isinstance(value, str):
        plain = _PLAIN.fullmatch(value) and value.lower() not in _RESERVED
        return value if plain else json.dumps(value, ensure_ascii=False)
    return str(value)
