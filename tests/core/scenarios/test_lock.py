"""Locks: agents are drawn once and read ever after."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios import lock as locks
from crowdbot.core.scenarios.library import open_spec, open_suite
from crowdbot.core.scenarios.lock import make_lock, population, write_lock
from crowdbot.core.scenarios.lock_check import differences
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.identity.canonical import dump_scenario_yaml
from crowdbot.dsl.scenario.agent_tables import join_tables, split_tables, table_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expand import Expanding
from crowdbot.errors import InputError
from tests.paths import DATA

REGISTRY = discover(allow=())
PARTS = DATA / "diagnostics" / "parts"
SUITE = """\
crowdbot: 1
suite: {id: s, seed: 7}
base: {extends: minimal.yaml}
matrix:
  pace: {slow: {crowd.speed.mean: 1}, fast: {crowd.speed.mean: 2}}
  range: {r1: {crowd.costs.reflex.range: 1}, r2: {crowd.costs.reflex.range: 2}}
seeds: {crowd: [pace]}
references: {robot_alone: {crowd: null}, crowd_alone: {robots: {}}, other: {crowd.speed.std: 0.2}}
"""


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    (tmp_path / "minimal.yaml").write_bytes((PARTS / "minimal.yaml").read_bytes())
    file = tmp_path / "s.yaml"
    file.write_text(SUITE, encoding="utf-8")
    relock(file)
    return file


def relock(file: Path) -> int:
    expansion, files = open_suite(str(file), REGISTRY)
    made = make_lock(expansion, REGISTRY, files)
    write_lock(files, made)
    return made.drawn


def opened(file: Path, *overrides: str) -> list[Scenario]:
    return open_spec(str(file), REGISTRY, overrides).scenarios


def found(file: Path) -> list[tuple[str, str]]:
    expansion, files = open_suite(str(file), REGISTRY)
    return [(d.what, d.id) for d in differences(expansion, files, REGISTRY)]


@pytest.fixture
def no_drawing(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("agents were drawn")

    monkeypatch.setattr(locks, "realise", refuse)


@pytest.mark.usefixtures("suite", "no_drawing")
def test_locked_agents_are_read_and_never_drawn(suite: Path) -> None:
    for scenario in opened(suite):
        for one in (scenario, *scenario.references.values()):
            people = population(one, REGISTRY)
            assert people.source == ("none" if one.crowd is None else "locked")
            assert people.agents.hash == realise(one).hash
            assert len(people.agents) == (0 if one.crowd is None else 50)


@pytest.mark.usefixtures("suite", "no_drawing")
def test_what_the_drawing_does_not_depend_on_may_be_set(suite: Path) -> None:
    changes = ("rates.log=8", "crowd.costs.reflex.weight=3", "robots.robot.task.time_limit=9")
    (one, *_) = opened(suite, *changes)
    assert population(one, REGISTRY).source == "locked"
    assert population(one.model_copy(update={"title": "x"}), REGISTRY).source == "locked"


@pytest.mark.parametrize(
    "change", ["crowd.speed.mean=1.5", "crowd.seed.root=8", "crowd.body.mass=70"]
)
def test_what_it_depends_on_is_drawn(suite: Path, change: str) -> None:
    (one, *_) = opened(suite, change)
    people = population(one, REGISTRY)
    assert people.source == "drawn"
    assert people.agents.hash == realise(one).hash
    assert people.agents.hash != population(opened(suite)[0], REGISTRY).agents.hash


def test_with_set_only_the_scenario_asked_for_is_expanded_anew(
    suite: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain, changed = opened(suite), opened(suite, "crowd.costs.reflex.weight=3")
    expanded: list[int] = []

    def noted(self: Expanding, index: int) -> Scenario:
        expanded.append(index)
        return scenario(self, index)

    scenario = Expanding.scenario
    monkeypatch.setattr(Expanding, "scenario", noted)
    for index in (2, 0):
        locked = changed[index].locked
        assert locked is not None
        assert locked.origin() == plain[index]
        assert locked.origin().references == plain[index].references
    assert set(expanded) == {0, 2}


def test_a_table_edited_by_hand_is_what_is_read_only_with_its_hash(suite: Path) -> None:
    table = suite.with_name("s.agents.csv")
    before = table.read_text()
    table.write_text(before.replace("\nslow,0,", "\nslow,1,", 1))
    with pytest.raises(InputError, match=r"table 'slow' was changed.*crowdbot lock"):
        population(opened(suite)[0], REGISTRY)
    assert found(suite) == [("agents", "slow")]
    assert relock(suite) == 1
    assert table.read_text() == before
    table.unlink()
    with pytest.raises(InputError, match=r"s\.agents\.csv: no such file"):
        population(opened(suite)[0], REGISTRY)


def test_a_lock_that_does_not_fit_is_an_error(suite: Path) -> None:
    suite.write_text(SUITE.replace("r2: {", "r3: {").replace("range: 1", "range: 1.5"))
    one, other, *_ = opened(suite)
    with pytest.raises(
        InputError, match=r"crowd.costs.reflex.range.value: changed, now 1.5.*'crowdbot lo"
    ):
        population(one, REGISTRY)
    with pytest.raises(InputError, match=r"no scenario slow-r3.*'crowdbot lock"):
        population(other, REGISTRY)
    changed = opened(suite, "rates.log=8")[0]
    with pytest.raises(InputError, match="crowdbot lock"):
        population(changed, REGISTRY)
    assert found(suite) == [
        ("changed", "slow-r1"), ("added", "slow-r3"), ("changed", "fast-r1"), ("added", "fast-r3"),
        ("removed", "slow-r2"), ("removed", "fast-r2"),
    ]  # fmt: skip
    assert relock(suite) == 0  # ranges do not matter to the drawing
    assert found(suite) == []


def test_a_new_reference_is_noticed(suite: Path) -> None:
    suite.write_text(SUITE.replace("crowd.speed.std: 0.2", "crowd.speed.std: 0.3"))
    assert ("agents", "slow-r1") in found(suite)
    assert relock(suite) == 2


def test_tables_are_kept_although_they_would_be_drawn_differently(
    suite: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = suite.with_name("s.agents.csv").read_text()

    def draw_others(scenario: Scenario, parts: EnvironmentParts) -> Realisation:
        other = scenario.model_copy(deep=True)
        if other.crowd is not None:
            seed = other.crowd.seed.model_copy(update={"root": other.crowd.seed.root + 1})
            other = other.model_copy(
                update={"crowd": other.crowd.model_copy(update={"seed": seed})}
            )
            assert realise(other, parts).hash != realise(scenario, parts).hash
        return realise(other, parts)

    monkeypatch.setattr(locks, "realise", draw_others)
    suite.write_text(SUITE.replace("{crowd.speed.mean: 2}", "{crowd.speed.mean: 3}"))
    assert relock(suite) == 2
    after = suite.with_name("s.agents.csv").read_text()
    tables = [split_tables(t, "t") for t in (before, after)]
    assert tables[0]["slow"] == tables[1]["slow"]
    assert tables[0]["fast"] != tables[1]["fast"]
    assert join_tables({k: v for k, v in tables[1].items() if k}) == after


def test_a_written_scenario_without_lock_is_drawn(suite: Path) -> None:
    one = opened(suite)[0]
    alone = suite.with_name("scenario.yaml")
    alone.write_text(dump_scenario_yaml(one, REGISTRY.spec_versions(one)), encoding="utf-8")
    (again,) = opened(alone)
    assert again == one
    assert population(again, REGISTRY).source == "drawn"
    assert population(again, REGISTRY).agents.hash == population(one, REGISTRY).agents.hash


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is not a lock"),
        ("[]", "is not a lock"),
        ("[" * 100_000, "is not a lock"),
        ("{}", "is not a lock: lock"),
        ('{"lock": 3, "crowdbot": "3.0"}', r"written by crowdbot 3\.0.*upgrade"),
        ('{"lock": 1, "crowdbot": "0.1.0"}', r"lock format 1, .* renew it with 'crowdbot lock "),
    ],
)
def test_broken_locks(suite: Path, text: str, message: str) -> None:
    suite.with_name("s.lock.json").write_text(text)
    with pytest.raises(InputError, match=message):
        population(opened(suite)[0], REGISTRY)


def test_both_files_or_none(suite: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = [suite.with_name(f"s.{n}") for n in ("agents.csv", "lock.json")]
    before, rename = [f.read_text() for f in files], Path.replace
    suite.write_text(SUITE.replace("{crowd.speed.mean: 2}", "{crowd.speed.mean: 3}"))

    def fails(self: Path, target: Path) -> Path:
        if target.suffix == ".json":
            raise OSError(28, "No space left on device")
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", fails)
    with pytest.raises(InputError, match="no space left"):
        relock(suite)
    assert [f.read_text() for f in files] == before
    assert sorted(p.name for p in suite.parent.iterdir()) == [
        "minimal.yaml", "s.agents.csv", "s.lock.json", "s.yaml",
    ]  # fmt: skip


def test_the_lock_says_what_it_holds(suite: Path) -> None:
    content = json.loads(suite.with_name("s.lock.json").read_text())
    assert content["suite"] == "s"
    assert list(content["scenarios"]) == ["slow-r1", "slow-r2", "fast-r1", "fast-r2"]
    assert sorted(content["draws"]) == ["fast", "fast~2", "slow", "slow~2"]
    one = content["scenarios"]["fast-r2"]
    assert one["draw"] == "fast"
    assert one["realisation"] == content["draws"]["fast"]["realisation"]
    assert content["places"] == [
        "crowd.costs.reflex.range.value", "crowd.seed.key", "crowd.speed.mean"
    ]  # fmt: skip
    assert all(
        re.fullmatch("[0-9a-f]{8}", x) for x in [*one["varied"], *content["common"].values()]
    )
    assert one["varied"][1:] == content["scenarios"]["fast-r1"]["varied"][1:]
    assert one["varied"][0] == content["scenarios"]["slow-r2"]["varied"][0]


@pytest.mark.parametrize(
    ("written", "instead", "named"),
    [
        ("base: {", "base: {crowd.body.mass: 70, ", "crowd.body.mass: changed, now 70.0"),
        ("slow: {crowd.speed.mean: 1}", "slow: {crowd.speed.mean: 1.1}",
         "crowd.speed.mean: changed, now 1.1"),
        ("base: {", "base: {crowd.costs.other: {kind: power_law}, ",
         "crowd.costs.other.kind: new, \"power_law\""),
        ("base: {", "base: {crowd.costs.reflex: {kind: power_law}, ", "crowd.costs.reflex.w: gone"),
    ],
)  # fmt: skip
def test_what_changed_is_named(suite: Path, written: str, instead: str, named: str) -> None:
    suite.write_text(SUITE.replace(written, instead))
    expansion, files = open_suite(str(suite), REGISTRY)
    by_id = {d.id: d for d in differences(expansion, files, REGISTRY) if d.what == "changed"}
    assert named in by_id["slow-r1"].details


def test_a_lock_of_format_1_is_renewed_with_its_tables(suite: Path) -> None:
    lock, table = suite.with_name("s.lock.json"), suite.with_name("s.agents.csv")
    before = table.read_text().replace("\nslow,0,", "\nslow,00,", 1)  # as never drawn
    table.write_text(before)
    content = json.loads(lock.read_text())
    content["lock"] = 1
    content["draws"]["slow"]["realisation"] = table_hash(split_tables(before, "")["slow"])
    lock.write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"lock format 1.*which keeps the agents"):
        population(opened(suite)[0], REGISTRY)
    assert relock(suite) == 0
    assert table.read_text() == before
    assert found(suite) == []


def test_a_suite_with_the_agents_of_the_one_it_extends_shares_their_file(suite: Path) -> None:
    other = suite.with_name("t.yaml")
    text = "crowdbot: 1\nextends: s.yaml\nsuite.id: t\nbase.crowd.costs.reflex.weight: 3\n"
    other.write_text(text)
    assert relock(other) == 4
    assert json.loads(other.with_name("t.lock.json").read_text())["agents"] == "s.agents.csv"
    assert not other.with_name("t.agents.csv").exists()
    assert found(other) == []
    assert population(opened(other)[0], REGISTRY).source == "locked"
    other.write_text(text + "base.crowd.body.mass: 70\n")
    assert relock(other) == 4
    assert json.loads(other.with_name("t.lock.json").read_text())["agents"] is None
    assert other.with_name("t.agents.csv").exists()
    assert found(other) == found(suite) == []
    other.write_text(text)
    assert relock(other) == 4
    assert not other.with_name("t.agents.csv").exists()


@pytest.mark.usefixtures("no_drawing")
@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("assistance", 35),
        ("challenge-2020", 162),
        ("challenge-2020-letter", 162),
        ("challenge-2020-literal", 162),
        ("challenge-2020-robots", 5 * 162),
        ("challenge-2021", 144),
        ("challenge-2021-2d", 12),
        ("challenge-2026", 162),
        ("shared-control", 60),
    ],
)
def test_packaged_suites_are_locked(name: str, count: int) -> None:
    """To accept a wanted change: crowdbot lock NAME."""
    expansion, files = open_suite(name, REGISTRY)
    assert len(files.lock.scenarios) == count
    assert differences(expansion, files, REGISTRY) == []
    assert population(expansion.scenarios[-1], REGISTRY).source == "locked"
