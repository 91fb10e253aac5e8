from __future__ import annotations

import json
import random
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.registry import discover
from crowdbot.dsl.identity.canonical import canonical_bytes, content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.dsl.suite.expand import expand_document, load_document

REGISTRY = discover(allow=())
KINDS = {"corridor": 1, "velocity_space": 1, "rvo": 1, "turtlebot2": 1}
DATA: dict[str, Any] = {
    "id": "x",
    "environment": {
        "kind": "corridor",
        "zones": {"crowd": {"x": [5, 45], "y": [-5, 5]}, "goal": {"x": [45, 50], "y": [-5, 5]}},
        "portals": {"a": {"x": [-1, 0], "y": [-5, 5]}, "b": {"x": [50, 51], "y": [-5, 5]}},
    },
    "crowd": {
        "flow": {"direction": "in", "density": 0.125, "area": "crowd"},
        "speed": {"mean": 0.8, "std": 0.03},
        "policy": {"kind": "velocity_space"},
        "costs": {"reflex": {"kind": "rvo", "range": 0.3}},
    },
    "robots": {
        "robot": {
            "model": {"kind": "turtlebot2"},
            "task": {"start": [5, 0, 0], "goal": {"zone": "goal"}},
        }
    },
}
#: A change of what happens, by path.
SEMANTIC = [
    ("environment.length", 51),
    ("environment.zones.crowd.x", [5, 37]),
    ("crowd.flow.direction", "counter"),
    ("crowd.flow.density", 0.25),
    ("crowd.speed.std", 0.031),
    ("crowd.body.mass", 70),
    ("crowd.costs.reflex.weight", 2),
    ("crowd.costs.reflex.range", {"value": 0.3, "measure": "surface"}),
    ("crowd.costs.second", {"kind": "rvo"}),
    ("crowd.seed", {"root": 1}),
    ("crowd.robot_response", {"velocity": "hidden"}),
    ("crowd.robot_response", {"late_fraction": 0.41}),
    ("crowd", None),
    ("robots", {}),
    ("robots.robot.task.start", [5, 0, 0.1]),
    ("robots.robot.task.time_limit", 181),
    ("robots.robot.sensors", {"s": {"kind": "lidar2d"}}),
    ("contact.stiffness", 1),
    ("rates.log", 8),
]


def scenario(data: dict[str, Any]) -> Scenario:
    return REGISTRY.scenario_model.model_validate(data)


def hash_of(data: dict[str, Any]) -> str:
    return content_hash(scenario(data), KINDS)


def changed(path: str, value: Any) -> dict[str, Any]:
    copy: dict[str, Any] = json.loads(json.dumps(DATA))
    *parents, last = path.split(".")
    node = copy
    for key in parents:
        node = node.setdefault(key, {})
    node[last] = value
    return copy


def test_golden_hashes_of_the_challenge() -> None:
    """A new one means: every lock file and every published result is void."""
    from crowdbot.core.scenarios.library import open_spec

    found = {s.id: content_hash(s, KINDS) for s in open_spec("challenge-2020", REGISTRY).scenarios}
    assert found["in-d0125-slow-c01-r02"] == GOLDEN[0]
    assert found["counter-d0500-dispersed-c50-r10"] == GOLDEN[1]


def test_golden_hash_and_bytes() -> None:
    assert hash_of(DATA) == GOLDEN[2]
    text = canonical_bytes(scenario(DATA), KINDS)
    assert text.startswith(
        b'{"contact":{"dissipation":0.3,"stiffness":30000.0},"crowd":{"agents":[],"body":'
    )
    assert b" " not in text
    assert b'"id"' not in text
    assert b'"kinds":{"corridor":1,' in text


def test_semantic_changes_move_the_hash() -> None:
    hashes = [hash_of(DATA), *(hash_of(changed(path, value)) for path, value in SEMANTIC)]
    assert len(set(hashes)) == len(hashes)
    assert content_hash(scenario(DATA), {**KINDS, "rvo": 2}) != hash_of(DATA)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("id", "y"),
        ("title", "Other"),
        ("crowd.body", {"radius": "33 cm"}),
        ("crowd.flow.density", "0.125 1/m^2"),
        ("crowd.costs.reflex.range", {"value": "300 mm", "measure": "centre"}),
        ("robots.robot.task.start", ["500 cm", -0.0, "0 deg"]),
        ("robots.robot.task.time_limit", "3 min"),
        ("rates", {"crowd": 16}),
    ],
)
def test_other_spellings_do_not(path: str, value: Any) -> None:
    assert hash_of(changed(path, value)) == hash_of(DATA)


def respelt(data: Any, rng: random.Random) -> Any:
    """The same data: keys in another order, whole numbers with or without a point."""
    if isinstance(data, dict):
        items = list(data.items())
        rng.shuffle(items)
        return {key: respelt(value, rng) for key, value in items}
    if isinstance(data, list):
        return [respelt(value, rng) for value in data]
    if isinstance(data, int | float) and float(data).is_integer():
        return rng.choice([int(data), float(data)])
    return data


@settings(max_examples=30)
@given(st.randoms(use_true_random=False))
def test_key_order_and_number_spelling_do_not_count(rng: random.Random) -> None:
    assert hash_of(respelt(DATA, rng)) == hash_of(DATA)


@settings(max_examples=30)
@given(st.integers(1, 10_000), st.sampled_from(["m", "cm", "mm"]))
def test_units_do_not_count(millimetres: int, unit: str) -> None:
    number = Decimal(millimetres) / Decimal({"m": 1000, "cm": 10, "mm": 1}[unit])
    written, plain = changed("contact.x", 0), millimetres / 1000
    for data, value in ((written, f"{number} {unit}"), (other := changed("contact.x", 0), plain)):
        del data["contact"]
        data["crowd"]["body"] = {"radius": value}
    assert hash_of(written) == hash_of(other)


@settings(max_examples=25)
@given(
    st.sampled_from(SEMANTIC),
    st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=20)
    | st.sampled_from(["no", "1e3", "007", "a: b", "#x", "~", "\u2028", "\ufeff", "'"]),
)
def test_dump_reads_back_to_the_same(
    tmp_path_factory: pytest.TempPathFactory, change: tuple[str, Any], title: str
) -> None:
    first = scenario({**changed(*change), "title": title})
    alone = scenario({**changed(*change), "crowd": None, "title": title})
    if first.crowd is not None and "second" not in change[0]:
        first = first.model_copy(update={"references": {"robot_alone": alone}})
    file = tmp_path_factory.mktemp("dump") / "scenario.yaml"
    file.write_text(dump_scenario_yaml(first), encoding="utf-8")
    (again,) = expand_document(load_document(file), REGISTRY.scenario_model).scenarios
    assert content_hash(again, KINDS) == content_hash(first, KINDS)
    assert (again.id, again.title) == (first.id, first.title)
    assert again.references == first.references


def test_dump_of_every_challenge_scenario_reads_back(tmp_path: Path) -> None:
    from crowdbot.core.scenarios.library import open_spec

    for one in open_spec("challenge-2020", REGISTRY).scenarios[::40]:
        file = tmp_path / "scenario.yaml"
        file.write_text(dump_scenario_yaml(one), encoding="utf-8")
        (again,) = expand_document(load_document(file), REGISTRY.scenario_model).scenarios
        assert again == one


def test_stream_seeds() -> None:
    assert stream_seed(20200430, "in-d0125-slow", "crowd.spawn") == SEED
    streams = {stream_seed(r, k, s) for r in (0, 1) for k in ("", "a") for s in ("x", "y")}
    assert len(streams) == 8
    assert all(0 <= s < 2**64 for s in streams)


SEED = 5666247128274042229
GOLDEN = (
    "cb1-sha256:677b5dcc0b8486f91c25061f37d7607b9ffd8f127b9da855529d7b5c50611a6c",
    "cb1-sha256:a5e7ba4925e6507beaf71fa3d11bc22be3fbab38fcc1a6945f53f3b5fa0268b3",
    "cb1-sha256:7a71fbcea5d609d8d17bde353d83e8d19508255f4797a15587e5be0c9ed7a7f5",
)
