"""Files that components read: found beside the document that names them, hashed by content."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError, SpecError
from crowdbot.plugins.crowd.policies.replay import ReplaySpec

REGISTRY = discover(allow=())
RECORD = "t,id,x,y\n0,7,10,0\n4,7,14,3\n1.5,9,20,1\n2.5,9,20,3\n"
HALL = """\
  extends: ["builtin:parts/corridor_50x10.yaml", parts/crowd.yaml]
"""
DOCUMENT = f"crowdbot: 1\nscenario:\n  id: x\n{HALL}"
CROWD = "crowd:\n  policy: {kind: replay, file: ../data/people.csv}\n"


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A scenario that extends a part, which names a record in a third folder."""
    folder = tmp_path / "study"
    for name in ("parts", "data"):
        (folder / name).mkdir(parents=True)
    (folder / "x.yaml").write_text(DOCUMENT)
    (folder / "parts" / "crowd.yaml").write_text(CROWD)
    (folder / "data" / "people.csv").write_text(RECORD)
    return folder


def opened(file: Path, *overrides: str) -> Expansion:
    return open_spec(str(file), REGISTRY, overrides)


def only(file: Path, *overrides: str) -> Scenario:
    (scenario,) = opened(file, *overrides).scenarios
    return scenario


def asset(scenario: Scenario) -> Asset:
    assert scenario.crowd is not None
    assert isinstance(scenario.crowd.policy, ReplaySpec)
    return scenario.crowd.policy.file


def identity(scenario: Scenario) -> str:
    return content_hash(scenario, REGISTRY.spec_versions(scenario))


def codes(file: Path, *overrides: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        opened(file, *overrides)
    return [d.code for d in caught.value.diagnostics]


def test_a_path_is_relative_to_the_file_that_names_it(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hashes = set()
    for folder, name in ((study.parent, "study/x.yaml"), (study, "x.yaml"), (Path("/"), study)):
        monkeypatch.chdir(folder)
        scenario = only(Path(name) / "x.yaml" if name is study else Path(name))
        assert asset(scenario).file.samefile(study / "data" / "people.csv")
        hashes.add(identity(scenario))
    assert len(hashes) == 1


def test_path_and_content_are_in_the_document(study: Path) -> None:
    found = asset(only(study / "x.yaml"))
    assert found.path == "data/people.csv"  # from the top-level document
    assert found.sha256 == hashlib.sha256(RECORD.encode()).hexdigest()
    assert str(study) not in dump_scenario_yaml(only(study / "x.yaml"))


def test_the_hash_follows_the_content(study: Path) -> None:
    before = identity(only(study / "x.yaml"))
    (study / "data" / "people.csv").write_text(RECORD + "5,7,15,3\n")
    after = identity(only(study / "x.yaml"))
    assert before != after
    (study / "data" / "people.csv").write_text(RECORD)
    assert identity(only(study / "x.yaml")) == before


def test_the_way_to_the_same_file_does_not_count(study: Path) -> None:
    before = identity(only(study / "x.yaml"))
    (study / "x.yaml").write_text(DOCUMENT + "  crowd.policy.file: ./parts/../data/people.csv\n")
    assert identity(only(study / "x.yaml")) == before
    (study / "x.yaml").write_text(DOCUMENT + "  crowd.policy.file: {path: data/people.csv}\n")
    assert identity(only(study / "x.yaml")) == before


def test_a_resolved_document_reads_back(study: Path, tmp_path: Path) -> None:
    scenario = only(study / "x.yaml")
    text = dump_scenario_yaml(scenario, REGISTRY.spec_versions(scenario))
    beside, far = study / "resolved.yaml", tmp_path / "resolved.yaml"
    beside.write_text(text)
    far.write_text(text)
    assert only(beside) == only(far) == scenario
    assert identity(only(beside)) == identity(only(far)) == identity(scenario)
    assert len(realise(only(beside))) == 2
    with pytest.raises(InputError, match=r"people.csv: cannot be read"):
        realise(only(far))


def test_another_content_than_the_one_written_is_refused(study: Path) -> None:
    scenario = only(study / "x.yaml")
    (study / "resolved.yaml").write_text(dump_scenario_yaml(scenario))
    (study / "data" / "people.csv").write_text(RECORD + "5,7,15,3\n")
    assert codes(study / "resolved.yaml") == ["E213"]
    with pytest.raises(InputError, match="its content differs"):
        realise(scenario)  # changed after the document was read


def test_an_axis_of_records(study: Path) -> None:
    (study / "data" / "more.csv").write_text(RECORD + "0,11,30,0\n")
    (study / "s.yaml").write_text(
        f"crowdbot: 1\nsuite: {{id: s}}\nbase:\n{HALL}"
        "matrix:\n  who: {few: {}, more: {crowd.policy.file: data/more.csv}}\n"
        "  height: {low: {crowd.body.height: 1}, tall: {crowd.body.height: 2}}\n"
    )
    scenarios = opened(study / "s.yaml").scenarios
    assert [len(realise(s)) for s in scenarios] == [2, 2, 3, 3]
    assert len({identity(s) for s in scenarios}) == 4


def test_set_counts_from_the_document(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (study / "data" / "more.csv").write_text(RECORD + "0,11,30,0\n")
    monkeypatch.chdir("/")
    assert len(realise(only(study / "x.yaml", "crowd.policy.file=data/more.csv"))) == 3


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("data/peple.csv", "E201"),
        ("data", "E201"),
        ("data/pipe", "E201"),
        ("../people.csv", "E203"),
        ("data/link.csv", "E203"),
        ("/etc/hostname", "E203"),
        ("acme:people.csv", "E201"),
        ("3", "E111"),
        ("''", "E114"),
        ("{path: data/people.csv, sha256: abc}", "E116"),
        ("{path: data/people.csv, size: 3}", "E102"),
        ("{sha256: null}", "E103"),
    ],
)
def test_bad_paths_have_a_place(study: Path, path: str, code: str) -> None:
    (study.parent / "people.csv").write_text(RECORD)
    (study / "data" / "link.csv").symlink_to(study.parent / "people.csv")
    os.mkfifo(study / "data" / "pipe")
    (study / "x.yaml").write_text(
        DOCUMENT + f"  crowd: {{policy: {{kind: replay, file: {path}}}}}\n"
    )
    if code == "E103":  # nothing below it says the path
        (study / "parts" / "crowd.yaml").write_text("crowd: {}\n")
    assert codes(study / "x.yaml") == [code]


def test_a_crowd_of_recorded_people(study: Path) -> None:
    drawn = realise(only(study / "x.yaml"))
    assert drawn.id.tolist() == [7, 9]
    assert list(zip(drawn.x, drawn.y, strict=True)) == [(10.0, 0.0), (20.0, 1.0)]
    assert drawn.start_time.tolist() == [0.0, 1.5]
    assert drawn.speed.tolist() == [1.25, 2.0]  # 5 m in 4 s, 2 m in 1 s
    assert drawn.goals == (((14.0, 3.0),), ((20.0, 3.0),))
    assert set(drawn.at_goal) == {"remove"}


def test_named_people_stand_for_the_record(study: Path) -> None:
    rows = "  crowd.agents: [{id: 7, x: 10, y: 0, speed: 1, goals: [[14, 3]]}]\n"
    (study / "x.yaml").write_text(DOCUMENT + rows)
    assert realise(only(study / "x.yaml")).id.tolist() == [7]


def test_a_file_that_is_no_record_is_named(study: Path) -> None:
    (study / "data" / "people.csv").write_text("t,id,x,y\n0,7,10\n")
    with pytest.raises(InputError, match=r"people.csv:2: '0,7,10' is not t,id,x,y"):
        realise(only(study / "x.yaml"))


@pytest.mark.parametrize("path", ["/home/me/maps/people.csv", "'C:\\maps\\people.csv'"])
def test_absolute_paths_are_told_where_to_copy_the_file(study: Path, path: str) -> None:
    text = DOCUMENT + f"  crowd: {{policy: {{kind: replay, file: {path}}}}}\n"
    (study / "x.yaml").write_text(text)
    with pytest.raises(SpecError, match=r"copy it beside x\.yaml and write 'people\.csv'"):
        only(study / "x.yaml")
