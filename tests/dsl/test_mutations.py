"""Damaged documents: always positioned errors or a valid scenario, never anything else.

Two oracles say what may be valid. One knows from the mutation that it must be refused. The other
reads the text with another loader: a document that means the same must have the same hashes, one
that means something else must have others.

A larger campaign: CROWDBOT_MUTATIONS=20000 pytest tests/dsl/test_mutations.py; with
CROWDBOT_MUTATIONS_SEED=anything it is another one.
"""

from __future__ import annotations

import os
import random
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import installed
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.spec.quantities import UNITS
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.text.diagnostics import CODES, Diagnostic, Source, render
from crowdbot.dsl.text.nodes import parse, to_data
from crowdbot.dsl.text.plain_yaml import to_yaml
from crowdbot.errors import SpecError
from tests.examples import THOROUGH
from tests.paths import DATA

pytestmark = pytest.mark.slow

REGISTRY = discover(allow=())
INSTALLED = installed(REGISTRY)
COUNT = int(os.environ.get("CROWDBOT_MUTATIONS", "1000" if THOROUGH else "300"))
SEED = os.environ.get("CROWDBOT_MUTATIONS_SEED", "")
PARTS = DATA / "diagnostics" / "parts"
BODY = to_data(parse((PARTS / "minimal.yaml").read_text(), Source("minimal"), []))
DOCUMENT: dict[str, Any] = {
    "crowdbot": 1,
    "kinds": {"rvo": 1},
    "suite": {"id": "s", "title": "t", "seed": 3},
    "base": BODY,
    "matrix": {
        "flow": {"in": {"crowd.flow.direction": "in"}, "back": {"crowd.flow.direction": "counter"}},
        "range": {"r2": {"crowd.costs.reflex.range": "2 m"}, "r3": {}},
    },
    "only": {"flow": ["in", "back"]},
    "exclude": [{"flow": "in", "range": "r3"}],
    "draws": 2,
    "seeds": {"crowd": ["flow"]},
    "metrics": ["*"],
    "references": {"robot_alone": {"crowd": None}, "crowd_alone": {"robots": {}}},
}
TEXT = to_yaml(to_data(parse(to_yaml(DOCUMENT), Source("d"), [])))  # keys sorted
#: Maps whose keys anybody may choose: names of axes, zones, sensors.
FREE = {"matrix", "references", "zones", "portals", "costs", "robots", "sensors", "metrics"}
WRONG: tuple[Any, ...] = (None, True, -1, 1e300, "x", "3 kg", [], [[]], {}, {"kind": "x"},
                          {"a.b": 0}, "", 10**39, [None], {"": 1})  # fmt: skip

Path_ = tuple[Any, ...]
Mutation = Callable[[random.Random], bytes]


def places(node: Any, path: Path_ = ()) -> Iterator[Path_]:
    items = node.items() if isinstance(node, dict) else enumerate(node)
    for key, value in items:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


PLACES = list(places(DOCUMENT))


def fresh() -> Any:
    return to_data(parse(TEXT, Source("d"), []))


def parent(document: Any, path: Path_) -> Any:
    for key in path[:-1]:
        document = document[key]
    return document


def is_field(path: Path_) -> bool:
    """Whether the last name of a path is one of the language's, not one that somebody chose."""
    free = len(path) > 1 and path[-2] in FREE
    free = free or (len(path) == 3 and path[0] == "matrix") or isinstance(path[-1], int)
    return not free and "." not in path[-1] and path[0] not in ("only", "exclude", "kinds")


# ------------------------------------------------------------------ mutations of the tree
def dropped(rng: random.Random) -> bytes:
    document, path = fresh(), rng.choice(PLACES)
    del parent(document, path)[path[-1]]
    return to_yaml(document).encode()


def retyped(rng: random.Random) -> bytes:
    document, path = fresh(), rng.choice(PLACES)
    parent(document, path)[path[-1]] = rng.choice(WRONG)
    return to_yaml(document).encode()


def renamed(rng: random.Random) -> bytes:
    """A field by another name; always wrong."""
    document, path = fresh(), rng.choice([p for p in PLACES if is_field(p)])
    node, name = parent(document, path), path[-1]
    place = rng.randrange(len(name) + 1)
    other = rng.choice([name + "x", name[:place] + "q" + name[place:], name.upper(), f"{name}_"])
    node[other] = node.pop(name)
    return to_yaml(document).encode()


def in_another_unit(rng: random.Random) -> bytes:
    """A quantity of another dimension; always wrong."""
    document = fresh()
    fields = ["crowd.speed.mean", "crowd.body.radius", "robots.robot.task.time_limit"]
    dimensions = ["speed", "length", "duration"]
    index = rng.randrange(3)
    others = [u for d, units in UNITS.items() for u in units if d != dimensions[index]]
    unit = rng.choice([u for u in others if u not in UNITS[dimensions[index]]])
    document["base"][fields[index]] = f"{rng.randint(1, 9)} {unit}"
    return to_yaml(document).encode()


def written_twice(rng: random.Random) -> bytes:
    """A line with a scalar, twice; always wrong."""
    lines = TEXT.split("\n")
    index = rng.choice([i for i, x in enumerate(lines) if re.fullmatch(r" *\w+: [^{\[]+", x)])
    return "\n".join([*lines[: index + 1], *lines[index:]]).encode()


# ------------------------------------------------------------------ mutations of the text
def flipped(rng: random.Random) -> bytes:
    damaged = bytearray(TEXT.encode())
    for _ in range(rng.randint(1, 3)):
        index, what = rng.randrange(len(damaged)), rng.randrange(3)
        char = rng.choice([*b"\n\t :{}[],'\"&*!#%-0.|>~", 255, 0, 13, rng.randrange(256)])
        if what == 0:
            damaged[index] = char
        elif what == 1:
            damaged.insert(index, char)
        else:
            del damaged[index]
    return bytes(damaged)


def moved(rng: random.Random) -> bytes:
    lines = TEXT.split("\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    what = rng.randrange(4)
    if what == 0:
        lines[i], lines[j] = lines[j], lines[i]
    elif what == 1:
        del lines[min(i, j) : max(i, j)]
    elif what == 2:
        lines[i] = " " * rng.randint(1, 3) + lines[i]
    else:
        lines[i : i + 1] = [lines[i], lines[j]]
    return "\n".join(lines).encode()


def cut(rng: random.Random) -> bytes:
    return TEXT.encode()[: rng.randrange(len(TEXT))]


ALWAYS_WRONG = (renamed, in_another_unit, written_twice)
PERHAPS = (dropped, retyped, flipped, moved, cut)


# ------------------------------------------------------------------------------- oracles
def check_places(found: Sequence[Diagnostic], file: Path) -> None:
    lines = file.read_bytes().replace(b"\r", b"\n").count(b"\n") + 2
    assert found
    for one in found:
        assert one.code in CODES
        assert one.mark.source.name == str(file)
        assert 0 <= one.mark.line <= lines
        assert one.mark.column >= 0
        assert one.message


def outcome(file: Path) -> Expansion | str:
    """What a file expands to, or the text of its errors, each with a code and a place."""
    try:
        suite = load_document(file, installed=INSTALLED)
        expansion = expand_document(suite, REGISTRY.scenario_model)
    except SpecError as error:
        check_places(error.diagnostics, file)
        return render(error.diagnostics)
    assert len({s.id for s in expansion.scenarios}) == len(expansion.scenarios) > 0
    return expansion


def identity(expansion: Expansion) -> Any:
    """Everything that a document says, hashes for the scenarios."""
    scenarios = [
        (s.id, content_hash(s, {}), [(n, content_hash(r, {})) for n, r in s.references.items()])
        for s in expansion.scenarios
    ]
    return expansion.suite_id, expansion.title, scenarios, expansion.metrics


def meaning(text: bytes) -> Any:
    """The document as another loader reads it: all scalars as text, numbers as numbers."""
    return _plain(YAML(typ="base", pure=True).load(text.decode("utf-8-sig")))


def _plain(node: Any) -> Any:
    if isinstance(node, dict):
        return {str(key): _plain(value) for key, value in node.items()}
    if isinstance(node, list):
        return [_plain(item) for item in node]
    try:
        return float(node)
    except (TypeError, ValueError):
        return node


#: What is outside of all scenarios, or the same as if it were not written.
SILENT = {"kinds", "crowdbot"}


def said(document: Any) -> Any:
    """What counts of a document; of the matrix also the order."""
    axes = document.get("matrix")
    order = [(name, list(axes[name])) for name in axes] if isinstance(axes, dict) else axes
    return [order, {k: v for k, v in document.items() if k not in SILENT}]


@pytest.fixture(scope="module")
def original(tmp_path_factory: pytest.TempPathFactory) -> Any:
    file = tmp_path_factory.mktemp("original") / "d.yaml"
    file.write_text(TEXT)
    found = outcome(file)
    assert not isinstance(found, str), found
    assert len(found.scenarios) == 6
    return identity(found)


@pytest.mark.parametrize("mutation", PERHAPS)
def test_refused_or_understood(mutation: Mutation, tmp_path: Path, original: Any) -> None:
    rng, file, valid = random.Random(mutation.__name__ + SEED), tmp_path / "d.yaml", 0
    for _ in range(COUNT * 3 // 20):
        text = mutation(rng)
        file.write_bytes(text)
        found = outcome(file)
        if isinstance(found, str):
            continue
        valid += 1
        same = said(meaning(text)) == said(meaning(TEXT.encode()))
        if same:
            assert identity(found) == original, text.decode()
    assert valid < COUNT * 3 // 20 / 2


@pytest.mark.parametrize("mutation", ALWAYS_WRONG)
def test_refused(mutation: Mutation, tmp_path: Path) -> None:
    rng, file = random.Random(mutation.__name__ + SEED), tmp_path / "d.yaml"
    for _ in range(COUNT // 12):
        text = mutation(rng)
        file.write_bytes(text)
        assert isinstance(outcome(file), str), text.decode()
