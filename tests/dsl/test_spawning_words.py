"""Words of spawning: short forms, tables of agents, hashes, sample documents."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import content_hash, dump_scenario_yaml
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.spawning import Agent
from crowdbot.dsl.suite.agents_csv import read_agents
from crowdbot.dsl.text.diagnostics import Diagnostic, Source, render
from crowdbot.dsl.text.nodes import to_data
from crowdbot.errors import SpecError
from tests.examples import costly
from tests.paths import ROOT

ROOT = ROOT
EXAMPLES = sorted((ROOT / "scenario_specs" / "examples").glob("*.yaml"))
SNIPPETS = sorted((ROOT / "docs" / "howto" / "files").glob("spawn_[!b]*.yaml"))  # not the part
REGISTRY = discover(allow=())
BODY = """\
crowdbot: 1
scenario:
  id: x
  environment:
    kind: corridor
    zones: {hall: {x: [0, 40], y: [-5, 5]}}
    portals: {a: {x: [-1, 0], y: [-5, 5]}, b: {x: [40, 41], y: [-5, 5]}}
"""
CROWD = """\
  crowd:
    speed: {mean: 1.3, std: 0.1}
    policy: {kind: velocity_space}
    costs: {reflex: {kind: rvo}}
"""


@pytest.fixture(name="folder")
def _folder(tmp_path: Path) -> Path:
    (tmp_path / "inner").mkdir()
    return tmp_path


def opened(folder: Path, text: str, *overrides: str) -> Scenario:
    file = folder / "s.yaml"
    file.write_text(BODY + CROWD + text, encoding="utf-8")
    return open_spec(str(file), REGISTRY, overrides).scenarios[0]


def crowd_of(scenario: Scenario) -> Crowd:
    assert scenario.crowd is not None
    return scenario.crowd


def refused(folder: Path, text: str, *overrides: str) -> str:
    with pytest.raises(SpecError) as caught:
        opened(folder, text, *overrides)
    return render(caught.value.diagnostics).replace(f"{folder}/", "")


def hash_of(scenario: Scenario) -> str:
    return content_hash(scenario, REGISTRY.spec_versions(scenario))


# ------------------------------------------------------------------------- short forms
def test_short_and_long_forms_are_the_same(folder: Path) -> None:
    short = """\
    spawns:
      s: {area: hall, count: 4, standing: true, speed: 90 cm/s, radius: 0.2, policy: p}
    policies: {p: {policy: {kind: velocity_space}, costs: {reflex: {kind: rvo}}}}
"""
    long = """\
    spawns:
      s:
        area: hall
        count: 4
        standing: true
        speed: {value: 0.9, spread: 0}
        radius: {value: 20 cm}
        policy: [p]
    policies: {p: {policy: {kind: velocity_space}, costs: {reflex: {kind: rvo}}}}
"""
    assert hash_of(opened(folder, short)) == hash_of(opened(folder, long))


def test_everything_about_a_spawn_counts(folder: Path) -> None:
    text = """\
    goal_areas: {one: {area: hall}, two: {area: hall, next: [one]}}
    spawns: {s: {area: hall, count: 4, goals: {areas: [one, two]}}}
"""
    changes = {
        "area": "{centre: [20, 0], size: [40, 10]}", "count": "5", "spacing": "1", "heading": "1",
        "groups": "[{size: 2, frequency: 1}]", "goals.order": "random", "goals.count": "2",
        "goals.at_goal": "loop", "speed": "1.3", "radius": "{value: 0.33, spread: 0.1}",
        "mass": "70", "max_speed": "2", "max_acceleration": "4", "start_time": "1",
    }  # fmt: skip
    found = [opened(folder, text)]
    found += [opened(folder, text, f"crowd.spawns.s.{k}={v}") for k, v in changes.items()]
    found.append(opened(folder, text, "crowd.goal_areas.two.next=[two]"))
    assert len({hash_of(s) for s in found}) == len(changes) + 2


def test_dotted_keys_lead_into_spawns(folder: Path) -> None:
    text = "    spawns: {s: {area: hall, count: 4, standing: true, speed: {value: 1}}}\n"
    crowd = crowd_of(opened(folder, text, "crowd.spawns.s.speed.spread=0.2"))
    assert crowd.spawns["s"].model_dump()["speed"] == {"value": 1.0, "spread": 0.2}
    shown = refused(folder, text, "crowd.spawns.s.speed.sprade=0.2")
    assert "did you mean 'spread'?" in shown
    assert "overrides nothing" in refused(folder, text, "crowd.spawns.t.count=2")


# ------------------------------------------------------------------------------ tables
TABLE = 'id,x,y,speed,goals,portals\n1,2,3,80 cm/s,"4 5; 6 5",\n2,8,3,,,a>b\n'
ROWS = """\
    agents:
      - {id: 1, x: 2, y: 3, speed: 0.8, goals: [[4, 5], [6, 5]]}
      - {id: 2, x: 8, y: 3, portals: [a, b]}
"""


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("t.csv", TABLE),
        ("inner/other.csv", TABLE.replace("80 cm/s", "0.80").replace("1,2,3", "1,2.0,3e0")),
        ("t.csv", TABLE.replace("\n", "\r\n")),
        ("t.csv", "\ufeff" + TABLE + "\n\n"),
        ("t.csv", TABLE.replace("1,2,3", ' 1 ,"2",  3 ')),
        ("t.csv", "# two people\n" + TABLE.replace("2,8", "# the other\n2,8")),
        ("t.csv", TABLE.replace(",", ";").replace("1;2;3", "1;2,0;3").replace("80", "80,0")),
        ("t.csv", TABLE.replace(",", "\t").replace("4 5", "4,0 5,0")),
    ],
    ids=[
        "plain",
        "other name and numbers",
        "CRLF",
        "BOM and blank lines",
        "blanks and quotes",
        "comments",
        "semicolons",
        "tabs",
    ],
)
def test_a_table_is_its_rows(folder: Path, name: str, text: str) -> None:
    (folder / name).write_text(text, encoding="utf-8", newline="")
    scenario = opened(folder, f"    agents: {{csv: {name}}}\n")
    assert hash_of(scenario) == hash_of(opened(folder, ROWS))
    assert "csv" not in dump_scenario_yaml(scenario)


def test_the_order_of_columns_does_not_count_that_of_rows_does(folder: Path) -> None:
    (folder / "t.csv").write_text(
        'portals,goals,speed,y,x,id\n,"4 5; 6 5",0.8,3,2,1\na>b,,,3,8,2\n', encoding="utf-8"
    )
    turned = ROWS.split("\n")
    turned[1:3] = turned[2:0:-1]
    rows = hash_of(opened(folder, ROWS))
    assert hash_of(opened(folder, "    agents: {csv: t.csv}\n")) == rows
    assert hash_of(opened(folder, "\n".join(turned))) != rows


def test_a_table_is_found_beside_the_file_that_names_it(folder: Path) -> None:
    (folder / "inner" / "part.yaml").write_text("crowd.agents.csv: t.csv\n", encoding="utf-8")
    (folder / "inner" / "t.csv").write_text(TABLE, encoding="utf-8")
    (folder / "s.yaml").write_text(BODY + "  extends: inner/part.yaml\n" + CROWD, encoding="utf-8")
    (scenario,) = open_spec(str(folder / "s.yaml"), REGISTRY).scenarios
    assert [agent.id for agent in crowd_of(scenario).agents] == [1, 2]


def test_a_matrix_chooses_between_tables(folder: Path) -> None:
    (folder / "few.csv").write_text("id,x,y,goals\n1,2,3,4 4\n", encoding="utf-8")
    (folder / "many.csv").write_text("id,x,y,goals\n1,2,3,4 4\n2,4,3,4 4\n", encoding="utf-8")
    text = BODY.replace("scenario:\n  id: x", "suite: {id: x}\nbase:") + CROWD
    text += "matrix:\n  people:\n    few: {crowd.agents: {csv: few.csv}}\n"
    text += "    many: {crowd: {agents.csv: many.csv}}\n"
    (folder / "s.yaml").write_text(text, encoding="utf-8")
    found = open_spec(str(folder / "s.yaml"), REGISTRY).scenarios
    assert {s.id: len(crowd_of(s).agents) for s in found} == {"few": 1, "many": 2}


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("/etc/passwd", "E203"),
        ("../t.csv", "E203"),
        ("builtn:t.csv", "E201"),
        ("none.csv", "E201"),
        ("inner", "E001"),
        ("7", "E015"),
        ("binary.csv", "E001"),
        ("empty.csv", "E015"),
        ("header.csv", "E015"),
    ],
)
def test_tables_that_cannot_be_read(folder: Path, path: str, code: str) -> None:
    (folder.parent / "t.csv").write_text(TABLE, encoding="utf-8")
    (folder / "binary.csv").write_bytes(b"id,x,y\n\0")
    (folder / "empty.csv").write_text("\n", encoding="utf-8")
    (folder / "header.csv").write_text("id,x,y\n", encoding="utf-8")
    shown = refused(folder, f"    agents: {{csv: {path}}}\n")
    assert f"error[{code}]" in shown
    assert shown.count("error[") == 1
    assert "s.yaml:12" in shown


def test_set_reads_no_table(folder: Path) -> None:
    (folder / "t.csv").write_text(TABLE, encoding="utf-8")
    shown = refused(folder, ROWS, "crowd.agents={csv: t.csv}")
    assert "--set:1:14: error[E115] crowd.agents: a CSV is read where a file names it" in shown


VALUES = st.floats(-1e6, 1e6).map(lambda v: v + 0.0)
AGENTS = st.fixed_dictionaries(
    {"id": st.integers(0, 2**31 - 1), "x": VALUES, "y": VALUES},
    optional={
        "speed": st.floats(1e-3, 9),
        "start_time": st.floats(0, 99),
        "group": st.integers(-1, 9),
        "policy": st.text("abc ,\"'é;1", min_size=1, max_size=6).filter(lambda t: t == t.strip()),
        "goals": st.lists(st.tuples(VALUES, VALUES).map(list), min_size=1, max_size=3),
        "portals": st.sampled_from([["a", "b"], ["b", "a"]]),
    },
)


@costly(100)
@given(st.lists(AGENTS, min_size=1, max_size=5))
def test_what_is_written_is_read(agents: list[dict[str, Any]]) -> None:
    out = io.StringIO()
    rows = csv.DictWriter(out, list(Agent.model_fields), lineterminator="\n")
    rows.writeheader()
    for agent in agents:
        words = {
            "goals": ";".join(f"{x!r} {y!r}" for x, y in agent.get("goals", [])),
            "portals": ">".join(agent.get("portals", [])),
        }
        rows.writerow({k: v if isinstance(v, str) else repr(v) for k, v in agent.items()} | words)
    problems: list[Diagnostic] = []
    node = read_agents(out.getvalue(), Source("t"), problems)
    assert not problems
    assert to_data(node) == [dict(sorted(agent.items())) for agent in agents]


@costly(300)
@given(st.text('id,xy\n"; >a.1-e\té\u2028', max_size=60) | st.text(max_size=40))
def test_any_text_is_a_table_or_an_error_with_a_place(text: str) -> None:
    lines = text.split("\n")
    problems: list[Diagnostic] = []
    for head in ("", "id,x,y\n", "id,x,y,goals,portals\n"):
        read_agents(head + text, Source("t", (head + text).split("\n")), problems)
    assert all(d.mark.line <= len(lines) for d in problems)
    render(problems)


@pytest.mark.slow
def test_ten_thousand_agents_in_one_place_are_checked_in_time(folder: Path) -> None:
    """Overlaps are found through a grid, and each agent is named once at most."""
    rows = "".join(f"{i},{1 + 0.0001 * (i % 7)},0,9 0\n" for i in range(10_000))
    (folder / "t.csv").write_text("id,x,y,goals\n" + rows, encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        opened(folder, "    agents: {csv: t.csv}\n")
    marks = [d.mark for d in caught.value.diagnostics if d.code == "E139"]
    assert 100 < len(marks) == len(set(marks)) == len(caught.value.diagnostics)


# --------------------------------------------------------------------------- documents
@pytest.mark.parametrize("path", EXAMPLES + SNIPPETS, ids=lambda p: p.stem)
def test_samples_are_valid_and_can_be_drawn(path: Path) -> None:
    for scenario in open_spec(str(path), REGISTRY).scenarios:
        table = realise(scenario)
        assert len(table) > 0
        again = type(table).from_csv(table.to_csv())
        assert again.hash == table.hash


def test_there_are_samples() -> None:
    assert {"cafe_crossing", "bidirectional_corridor", "explicit_agents"} <= {
        p.stem for p in EXAMPLES
    }
    assert len(SNIPPETS) > 6


def test_the_bidirectional_corridor_has_a_hundred_people() -> None:
    (path,) = [p for p in EXAMPLES if p.stem == "bidirectional_corridor"]
    for scenario in open_spec(str(path), REGISTRY).scenarios:
        table = realise(scenario)
        assert len(table) == 100
        assert set(table.portals) == {("a", "b"), ("b", "a")}


def test_kinds_of_named_policies_are_versioned(folder: Path) -> None:
    named = "{policy: {kind: velocity_space}, costs: {far: {kind: ttca_dca}}}"
    scenario = opened(folder, f"{ROWS}    policies: {{p: {named}}}\n")
    assert "ttca_dca" in REGISTRY.spec_versions(scenario)
    shown = refused(folder, f"{ROWS}    policies: {{p: {named.replace('kind: ttca_dca', '')}}}\n")
    assert "error[E103] missing field 'kind' in crowd.policies.p.costs.far" in shown


def test_json_schema_knows_the_short_forms() -> None:
    schema = REGISTRY.scenario_model.model_json_schema()["$defs"]
    spawn = schema["Spawn"]["properties"]
    assert {"type": "string"} in spawn["area"]["anyOf"]
    assert {"type": "number"} in spawn["heading"]["anyOf"]
    assert {"type": "string"} in spawn["policy"]["anyOf"]
    crowd = next(v for k, v in schema.items() if k.endswith("Crowd"))
    files = [one["$ref"] for one in crowd["properties"]["agents"]["anyOf"] if "$ref" in one]
    assert files == ["#/$defs/AgentsFile"]


@pytest.mark.slow
def test_validating_spawns_needs_no_numpy() -> None:
    code = (
        "import json, sys; from crowdbot.cli import main\n"
        f"assert main(['validate', {str(EXAMPLES[0])!r}]) == 0\n"
        "print(json.dumps([m for m in ('numpy', 'numba', 'pydrake') if m in sys.modules]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout.splitlines()[-1]) == []
