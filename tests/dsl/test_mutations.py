"""Damaged documents: always positioned errors or a valid scenario, never anything else."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.registry import discover
from crowdbot.dsl.canonical import to_yaml
from crowdbot.dsl.diagnostics import CODES, Diagnostic, Source, render
from crowdbot.dsl.expand import expand_document, load_document
from crowdbot.dsl.nodes import parse, to_data
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())
PARTS = Path(__file__).parent.parent / "data" / "diagnostics" / "parts"
BODY = to_data(parse((PARTS / "minimal.yaml").read_text(), Source("minimal"), []))
DOCUMENT: dict[str, Any] = {
    "crowdbot": 1,
    "suite": {"id": "s", "title": "t", "seed": 3},
    "base": BODY,
    "matrix": {
        "flow": {"in": {"crowd.flow.direction": "in"}, "back": {"crowd.flow.direction": "counter"}},
        "range": {"r2": {"crowd.costs.reflex.range": "2 m"}},
    },
    "seeds": {"crowd": ["flow"]},
    "metrics": ["*"],
    "references": {"robot_alone": {"crowd": None}, "crowd_alone": {"robots": {}}},
}
WRONG: tuple[Any, ...] = (
    None,
    True,
    -1,
    1e300,
    "x",
    "3 kg",
    [],
    [[]],
    {},
    {"kind": "x"},
    {"a.b": 0},
)


def places(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    items = node.items() if isinstance(node, dict) else enumerate(node)
    for key, value in items:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def mutated(path: tuple[Any, ...], how: str, rng: random.Random) -> dict[str, Any]:
    copy: dict[str, Any] = parse_again(DOCUMENT)
    node: Any = copy
    for key in path[:-1]:
        node = node[key]
    if how == "drop":
        del node[path[-1]]
    elif how == "rename" and isinstance(node, dict):
        node[f"{path[-1]}x"] = node.pop(path[-1])
    else:
        node[path[-1]] = rng.choice(WRONG)
    return copy


def parse_again(document: Any) -> Any:
    return to_data(parse(to_yaml(document), Source("d"), []))


def check_places(found: Sequence[Diagnostic], file: Path) -> None:
    lines = file.read_bytes().replace(b"\r", b"\n").count(b"\n") + 2
    assert found
    for one in found:
        assert one.code in CODES
        assert one.mark.source.name == str(file)
        assert 0 <= one.mark.line <= lines
        assert one.mark.column >= 0


def outcome(file: Path) -> str:
    """``valid``, or the text of the errors; each must have a code and a place in the file."""
    try:
        expansion = expand_document(
            load_document(file, metrics=REGISTRY.components("metric")), REGISTRY.scenario_model
        )
    except SpecError as error:
        check_places(error.diagnostics, file)
        return render(error.diagnostics)
    assert len({s.id for s in expansion.scenarios}) == len(expansion.scenarios)
    return "valid"


def test_the_document_itself_is_valid(tmp_path: Path) -> None:
    file = tmp_path / "d.yaml"
    file.write_text(to_yaml(DOCUMENT))
    assert outcome(file) == "valid"


@pytest.mark.parametrize("how", ["drop", "rename", "retype"])
def test_fields(tmp_path: Path, how: str) -> None:
    rng, file, refused = random.Random(how), tmp_path / "d.yaml", 0
    paths = list(places(DOCUMENT))
    for path in paths:
        file.write_text(to_yaml(mutated(path, how, rng)))
        refused += outcome(file) != "valid"
    assert refused > len(paths) / 3


def test_bytes(tmp_path: Path) -> None:
    rng, file, refused = random.Random(5), tmp_path / "d.yaml", 0
    text = to_yaml(DOCUMENT).encode()
    for _ in range(150):
        damaged = bytearray(text)
        for _ in range(rng.randint(1, 3)):
            damaged[rng.randrange(len(damaged))] = rng.choice(
                [*b"\n\t :{}[],'\"&*!#%-0", 255, 0, 13]
            )
        file.write_bytes(damaged)
        refused += outcome(file) != "valid"
    assert refused > 50


def test_cut_off(tmp_path: Path) -> None:
    file, text = tmp_path / "d.yaml", to_yaml(DOCUMENT).encode()
    for end in range(0, len(text), 29):
        file.write_bytes(text[:end])
        outcome(file)
