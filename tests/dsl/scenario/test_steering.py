"""Steering in documents: off by default, and then a scenario's hash does not know it."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import pytest

from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.crowd.steering.parts import PARTS, part_numbers, parts_of
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import canonical_bytes, content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.steering import SteeringSpec, TimeGapSpec, WanderSpec
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())


def scenario(*overrides: str) -> Scenario:
    return open_spec("challenge-2020", REGISTRY, overrides).scenarios[0]


def test_unset_is_not_in_the_hash() -> None:
    plain = canonical_bytes(scenario(), {})
    assert b"steering" not in plain
    assert b"avoided_radius" not in plain


def test_each_part_changes_the_hash_and_reads_back(tmp_path: Path) -> None:
    found = {content_hash(scenario(), {})}
    for change in (
        "crowd.steering.time_gap.time=1 s",
        "crowd.steering.personal_space.reach=0.4 m",
        "crowd.steering.lanes.reach=1 m",
        "crowd.steering.wall_push.reach=0.1 m",
        "crowd.steering.wander.time=0.5 s",
        "crowd.body.avoided_radius=0.2 m",
    ):
        changed = scenario(change)
        found.add(content_hash(changed, {}))
        path = tmp_path / "again.yaml"
        path.write_text(dump_scenario_yaml(changed))
        again = open_spec(str(path), REGISTRY).scenarios[0]
        assert content_hash(again, {}) == content_hash(changed, {})
    assert len(found) == 7


def test_wrong_words_and_numbers_are_refused() -> None:
    with pytest.raises(SpecError, match="time_gab"):
        scenario("crowd.steering.time_gab.time=1 s")
    with pytest.raises(SpecError, match="behind"):
        scenario("crowd.steering.personal_space.behind=1.5")


def test_every_part_has_a_function_and_parts_that_are_not_named_are_off() -> None:
    assert list(SteeringSpec.model_fields) == list(PARTS)
    for name, fields in PARTS.items():
        annotation = SteeringSpec.model_fields[name].annotation
        (part,) = (a for a in get_args(annotation) if a is not type(None))
        assert list(part.model_fields) == list(fields)
    crowd = scenario(
        "crowd.steering.time_gap.time=0.8 s", "crowd.steering.wander.deviation=0.1 m/s^2"
    ).crowd
    assert crowd is not None
    assert crowd.steering == SteeringSpec(
        time_gap=TimeGapSpec(time=0.8), wander=WanderSpec(deviation=0.1)
    )
    assert part_numbers(crowd.steering)[:, 0].tolist() == [1.0, 0.0, 0.0, 0.0, 1.0]
    assert parts_of(Steering(crowd.steering)) is not None
    assert parts_of(Steering()) is None
