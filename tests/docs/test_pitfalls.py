"""Every paragraph of the page of pitfalls, as a fact. A test is named after its heading."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.view.build import build_map_content
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import SpecError
from tests.docs.doc_pages import read
from tests.paths import ROOT

REGISTRY = discover(allow=())
FILES = ROOT / "docs" / "tutorial" / "files"
HALL = (FILES / "my_scenario.yaml").read_text(encoding="utf-8")
STUDY = (FILES / "my_study.yaml").read_text(encoding="utf-8")


def hall(*overrides: str) -> Scenario:
    return open_spec(str(FILES / "my_scenario.yaml"), REGISTRY, overrides).scenarios[0]


def codes(*overrides: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        hall(*overrides)
    return [d.code for d in caught.value.diagnostics]


def written(folder: Path, text: str) -> dict[str, Scenario]:
    file = folder / "x.yaml"
    file.write_text(text, encoding="utf-8")
    return {s.id: s for s in open_spec(str(file), REGISTRY).scenarios}


def digest(scenario: Scenario) -> str:
    return content_hash(scenario, REGISTRY.spec_versions(scenario))


def spec(component: object) -> Any:
    return component


def test_every_heading_has_a_test() -> None:
    headings = re.findall(r"^## (.+)$", read("explanation/pitfalls.md"), re.MULTILINE)
    slugs = {re.sub(r"\W+", "_", h.lower()).strip("_") for h in headings}
    tests = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert slugs == tests - {"every_heading_has_a_test"}


def test_a_bare_number_is_in_si_units() -> None:
    turned = hall("robots.robot.task.start=[1, 0, 180]").robots["robot"].task
    assert turned.start[2] == 180.0
    assert hall("robots.robot.task.time_limit=3 min").robots["robot"].task.time_limit == 180.0
    assert codes("robots.robot.task.time_limit='180'") == ["E110"]


def test_a_unit_that_begins_with_a_digit_needs_a_blank() -> None:
    flow = spec(hall("crowd.flow.density=0.5 1/m²").crowd).flow
    assert flow.density == 0.5
    assert codes("crowd.flow.density=0.51/m^2") == ["E110"]
    assert hall("crowd.body.max_acceleration=5m/s²").crowd == hall().crowd
    assert codes("crowd.body.max_acceleration=5 m/s2") == ["E110"]


def test_yaml_words_are_text(tmp_path: Path) -> None:
    assert set(written(tmp_path, STUDY.replace("    few:", "    on:"))) >= {"in-on-far-n01"}
    assert hall("title=12:30").title == "12:30"
    assert digest(hall("robots.robot.sensors.front.noise=1e-3")) == digest(hall())
    assert "E008" in codes("crowd.body.mass=010")
    assert codes("title=2020") == ["E111"]


def test_lists_are_replaced_maps_are_merged() -> None:
    assert codes("robots.robot.task.start=[4 m]") != []
    costs = spec(hall("crowd.costs.mid_term.weight=3").crowd).costs
    assert (costs["mid_term"].weight, set(costs)) == (3.0, {"mid_term", "reflex"})


def test_the_later_layer_wins_not_the_later_line(tmp_path: Path) -> None:
    (tmp_path / "part.yaml").write_text("crowd.body: {radius: 0.2, height: 1.5}\n")
    top = HALL.replace("  id: hall", "  id: hall\n  extends: part.yaml")
    bottom = HALL.replace("rates:", "extends: part.yaml\n  rates:")
    for text in (top, bottom):
        body = spec(written(tmp_path, text)["hall"].crowd).body
        assert (body.radius, body.height) == (0.3, 1.5)
    assert spec(hall("crowd.body.radius=0.1", "crowd.body.radius=0.4").crowd).body.radius == 0.4
    clash = STUDY.replace("crowd.costs.mid_term.range: 2 m", "crowd.flow.direction: in")
    with pytest.raises(SpecError, match="E205"):
        written(tmp_path, clash)


def test_another_kind_starts_afresh() -> None:
    before = spec(hall("crowd.costs.mid_term.weight=20").crowd).costs["mid_term"]
    after = spec(hall("crowd.costs.mid_term={kind: rvo}").crowd).costs["mid_term"]
    assert (before.weight, after.weight, after.kind) == (20.0, 1.0, "rvo")


def test_empties_null_removes_nothing_changes_nothing(tmp_path: Path) -> None:
    assert hall("crowd=null").crowd is None
    assert hall("robots={}").robots == {}
    assert spec(hall("crowd.body.radius=null").crowd).body.radius == 0.33
    same = STUDY.replace("few: {crowd.flow.density: 0.25 1/m^2}", "few: {}")
    assert len(written(tmp_path, same)) == 12


def test_density_times_area_is_people() -> None:
    assert len(realise(hall())) == round(0.25 * 14 * 6)
    assert codes("crowd.flow.density=0.26") == ["E131"]


def test_a_label_is_a_name_for_good(tmp_path: Path) -> None:
    before = written(tmp_path, STUDY)["in-few-far-n01"]
    after = written(tmp_path, STUDY.replace("few:", "sparse:"))["in-sparse-far-n01"]
    assert realise(before).hash != realise(after).hash


def test_axes_that_are_not_in_seeds_share_their_people(tmp_path: Path) -> None:
    found = written(tmp_path, STUDY)
    near, far = (realise(found[f"in-few-{r}-n01"]).hash for r in ("near", "far"))
    assert near == far
    alone = re.sub(r"^seeds: .*\n", "", STUDY, flags=re.MULTILINE)
    found = written(tmp_path, alone)
    assert realise(found["in-few-near-n01"]).hash != realise(found["in-few-far-n01"]).hash


def test_equal_hashes_are_equal_scenarios(tmp_path: Path) -> None:
    one = digest(hall())
    assert digest(hall("title=other", "crowd.body.radius=0.3")) == one
    assert digest(written(tmp_path, HALL.replace("metrics: [", "metrics: [risk, "))["hall"]) == one
    assert digest(hall("crowd.body.height=1.71")) != one
    assert digest(hall("crowd.body.height=170 cm")) == one


def test_two_seeds(tmp_path: Path) -> None:
    before, after = (
        written(tmp_path, STUDY.replace("seed: 2026", f"seed: {n}")) for n in (2026, 2027)
    )
    assert realise(before["in-few-far-n01"]).hash != realise(after["in-few-far-n01"]).hash
    assert digest(before["in-few-far-n01"]) != digest(after["in-few-far-n01"])


def test_a_range_counts_from_centre_to_centre() -> None:
    costs = spec(hall("crowd.costs.reflex={kind: rvo, range: 0.3 m}").crowd).costs
    assert costs["reflex"].range.measure == "centre"
    assert spec(hall().crowd).costs["reflex"].range.measure == "surface"
    assert 2 * spec(hall("crowd.body.radius=null").crowd).body.radius > 0.3


def test_frames() -> None:
    turned = hall(
        "robots.robot.task.start=[1, 0, 90 deg]",
        "robots.robot.sensors.front.mount={x: 0.5, yaw: 180 deg}",
    )
    content = build_map_content(turned, realise(turned), REGISTRY)
    (sensor,) = content.robots[0].sensors
    assert (sensor.x, sensor.y) == pytest.approx((1.0, 0.5))
    assert 0.5 * (sensor.start + sensor.end) == pytest.approx(1.5 * math.pi)  # backwards


def test_a_matrix_hides_mistakes_in_the_base(tmp_path: Path) -> None:
    wrong = STUDY.replace("direction: in, portals", "direction: sideways, portals")
    assert wrong != STUDY
    assert len(written(tmp_path, wrong)) == 12
