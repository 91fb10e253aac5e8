"""The hash of a scenario: still under every reformatting, moved by every semantic change."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import canonical_bytes, content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario.field_hashes import flatten
from crowdbot.dsl.scenario.scenario import OUTSIDE_HASH, Scenario
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.errors import SpecError
from tests.examples import costly

REGISTRY = discover(allow=())
ONE = open_spec("challenge-2020", REGISTRY).scenarios[0]
DATA: dict[str, Any] = json.loads(ONE.model_dump_json())
#: A spelling of the same number in another unit, where the factor is exact.
UNITS: dict[str, Callable[[float], str]] = {
    "crowd.speed.mean": lambda x: f"{x} m/s",
    "crowd.body.radius": lambda x: f"{x:.4f} m",
    "robots.robot.task.time_limit": lambda x: f"{x / 60:g} min",
    "environment.length": lambda x: f"{x * 100:g} cm",
    "crowd.flow.density": lambda x: f"{x} 1/m^2",
}


def read(text: str, folder: Path) -> Scenario:
    file = folder / "scenario.yaml"
    file.write_text(text, encoding="utf-8", newline="")
    (scenario,) = expand_document(load_document(file), REGISTRY.scenario_model).scenarios
    return scenario


def hash_of(scenario: Scenario) -> str:
    return content_hash(scenario, REGISTRY.spec_versions(scenario))


class Formatter:
    """Writes data as YAML in a random style."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng

    def document(self, data: dict[str, Any]) -> str:
        text = "crowdbot: 1\nscenario:\n" + self._block(data, 1, "")
        ends = self.rng.choice(["\n", "\r\n"])
        return self.rng.choice(["", "\ufeff"]) + text.replace("\n", ends)

    def _block(self, data: dict[str, Any], depth: int, path: str) -> str:
        items, lines = list(data.items()), []
        self.rng.shuffle(items)
        for key, value in items:
            here = f"{path}.{key}" if path else key
            name = self.rng.choice([key, f'"{key}"', f"'{key}'"])
            indent = "  " * depth
            if self.rng.random() < 0.2:
                lines.append(f"{indent}# {self.rng.randint(0, 99)}: {{")
            if isinstance(value, dict) and value and self.rng.random() < 0.7:
                lines.append(f"{indent}{name}:\n{self._block(value, depth + 1, here).rstrip()}")
            elif isinstance(value, dict) and len(value) == 1 and self.rng.random() < 0.5:
                ((inner, item),) = value.items()
                lines.append(f"{indent}{key}.{inner}: {self._flow(item, f'{here}.{inner}')}")
            else:
                lines.append(f"{indent}{name}: {self._flow(value, here)}{self._comment()}")
        return "\n".join(lines) + "\n"

    def _flow(self, value: Any, path: str) -> str:
        blank = self.rng.choice(["", " "])
        if isinstance(value, dict):
            items = list(value.items())
            self.rng.shuffle(items)
            inside = (f"{k}: {self._flow(v, f'{path}.{k}')}" for k, v in items)
            return f"{{{blank}{f',{blank} '.join(inside)}{blank}}}"
        if isinstance(value, list):
            return f"[{blank}{', '.join(self._flow(v, path) for v in value)}{blank}]"
        return self._scalar(value, path)

    def _scalar(self, value: Any, path: str) -> str:
        if isinstance(value, bool) or value is None:
            return json.dumps(value)
        if path in UNITS and self.rng.random() < 0.5:
            quote = self.rng.choice(["", '"', "'"])
            return f"{quote}{UNITS[path](value)}{quote}"
        if isinstance(value, int | float):
            return self._number(value)
        plain = [value] if value and value not in ("in", "counter") else []
        return str(self.rng.choice([json.dumps(value), f"'{value}'", *plain]))

    def _number(self, value: float) -> str:
        spellings = [repr(value)]
        if isinstance(value, float):
            spellings += [f"{value:.17e}", f"+{value!r}" if value >= 0 else repr(value)]
        if float(value).is_integer() and isinstance(value, float):
            spellings += [str(int(value)), f"{int(value)}."]
        return self.rng.choice(spellings)

    def _comment(self) -> str:
        return self.rng.choice(["", "", " # comment", "   # a: b"])


@pytest.mark.slow
@settings(costly(60), suppress_health_check=[HealthCheck.large_base_example])
@given(st.randoms(use_true_random=False))
def test_reformatting_does_not_move_the_hash(
    tmp_path_factory: pytest.TempPathFactory, rng: random.Random
) -> None:
    text = Formatter(rng).document(DATA)
    again = read(text, tmp_path_factory.mktemp("x"))
    assert again == ONE.model_copy(update={"references": {}}), text
    assert hash_of(again) == hash_of(ONE)


def test_parse_and_print_is_the_identity(tmp_path: Path) -> None:
    kinds = REGISTRY.spec_versions(ONE)
    text = dump_scenario_yaml(ONE, kinds)
    again = read(text, tmp_path)
    assert dump_scenario_yaml(again, kinds) == text
    assert canonical_bytes(again, kinds) == canonical_bytes(ONE, kinds)
    content = json.loads(canonical_bytes(ONE, kinds))
    assert content.pop("kinds") == kinds
    outside = {"id": ONE.id, "title": ONE.title}
    assert REGISTRY.scenario_model.model_validate({**content, **outside}) == ONE.model_copy(
        update={"references": {}}
    )


LEAVES = flatten(DATA)


def others(value: Any) -> list[Any]:
    """Other values for a leaf, of which at least one should be valid."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1]
    if isinstance(value, float):
        return [value * 1.0001, value + 1e-9, value * 2, value / 2, -value]
    if isinstance(value, list):
        changed = [[*value[:i], x, *value[i + 1 :]] for i, v in enumerate(value) for x in others(v)]
        return [*changed, value[::-1]]
    if value is None:
        return ["x", 1.0]
    words = ["counter", "hidden", "surface", "centre", "in", "robot_spawn", "crowd", "x"]
    return [w for w in words if w != value]


@pytest.mark.parametrize("path", [p for p in LEAVES if p not in OUTSIDE_HASH])
def test_every_leaf_moves_the_hash(path: str) -> None:
    tried = 0
    for other in others(LEAVES[path]):
        if other == LEAVES[path]:
            continue
        copy = json.loads(json.dumps(DATA))
        *parents, last = path.split(".")
        node = copy
        for key in parents:
            node = node[key]
        node[last] = other
        try:
            changed = REGISTRY.scenario_model.model_validate(copy)
        except ValueError:
            continue
        tried += 1
        assert content_hash(changed, {}) != content_hash(ONE, {}), (path, other)
    single = path.endswith(("kind", "control")) or LEAVES[path] in ({}, [], None)
    assert tried or single or isinstance(LEAVES[path], str), path


@pytest.mark.parametrize("path", OUTSIDE_HASH)
def test_what_is_outside_does_not(path: str) -> None:
    value: Any = {"r": ONE} if path == "references" else "other"
    assert hash_of(ONE.model_copy(update={path: value})) == hash_of(ONE)


@pytest.mark.slow
def test_parts_validated_once_give_the_same_hashes(monkeypatch: pytest.MonkeyPatch) -> None:
    """`ValidParts` is a shortcut and nothing else."""
    from crowdbot.dsl.checks.validation_cache import ValidParts

    def listed() -> list[str]:
        return [hash_of(s) for s in open_spec("challenge-2020", REGISTRY).scenarios]

    fast = listed()
    monkeypatch.setattr(ValidParts, "fill", lambda _self, _tree, data: dict(data))
    assert listed() == fast


def test_a_number_that_is_no_float_is_refused(tmp_path: Path) -> None:
    text = dump_scenario_yaml(ONE).replace("mass: 75.0", "mass: 1" + "0" * 400)
    with pytest.raises(SpecError, match="E008"):
        read(text, tmp_path)
