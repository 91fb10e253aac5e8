"""UMANS: agents, policies, obstacles and simulations become scenarios that decide alike."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.environments.build import build_environment
from crowdbot.core.exchange.checked import write
from crowdbot.core.exchange.umans.presets import PRESETS, preset
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.errors import SpecError
from scripts.crowd_oracle.case import Case
from scripts.crowd_oracle.step import Stepper
from tests.core.crowd.oracle_cases import FOLDER
from tests.core.exchange.importing import FILES, document_of, imported, notes, registry


def test_a_simulation_reads_the_files_that_it_names() -> None:
    scenario = document_of(imported("world.xml"))["scenario"]
    first, second = scenario["crowd"]["agents"]
    assert first == {
        "id": 0, "x": -3, "y": 0.25, "radius": 0.3, "speed": 1.2, "max_speed": 1.7,
        "max_acceleration": 4, "at_goal": "remove", "goals": [[4, 0]],
    }  # fmt: skip
    assert second["policy"] == "policy_2"
    assert (second["start_time"], second["radius"], second["speed"]) == (0.5, 0.24, 1.4)
    assert scenario["environment"]["blocks"]["obstacle"]["corners"] == [[-1, 2], [1, 2], [1, 3]]
    assert scenario["environment"]["walls"]["obstacle"]["thickness"] == 0.02


@pytest.mark.parametrize("files", [("world.xml", "agents.xml"), ("policies.xml", "world.xml")])
def test_files_that_are_given_and_named_are_read_once(files: tuple[str, str]) -> None:
    together, alone = imported(*files), imported("world.xml")
    assert len(together.ids) == 1
    assert document_of(together)["scenario"]["crowd"] == document_of(alone)["scenario"]["crowd"]
    assert together.report.counts() == alone.report.counts()


def test_mass_divides_contact_and_forces() -> None:
    policies = document_of(imported("world.xml"))["scenario"]["crowd"]["policies"]
    assert policies["policy_2"]["policy"]["contact_stiffness"] == 50
    assert policies["policy_2"]["costs"]["social_forces_avoidance"]["weight"] == 1.5


def test_nothing_is_dropped_silently() -> None:
    found = imported("world.xml")
    marks = [entry.at for entry in found.report.entries if entry.at]
    assert len({(m.source.name, m.line) for m in marks}) > 15
    left = notes(found, "left out")
    assert set(left) == {"Simulation@delta_time", "Simulation@end_time"}
    assert "(syntax)" in notes(found, "interpreted")


def test_agents_and_policies_are_combined(tmp_path: Path) -> None:
    other = tmp_path / "other.xml"
    other.write_text((FILES / "policies.xml").read_text().replace('w="2"', 'w="3"'))
    found = imported("agents.xml", "policies.xml", other)
    assert found.ids == ["agents_policies", "agents_other"]


@pytest.mark.parametrize("file", ["policies.xml", "world_alone.xml"])
def test_files_without_people_get_some(tmp_path: Path, file: str) -> None:
    (tmp_path / "world_alone.xml").write_text(
        '<Obstacles><Obstacle><Point x="0" y="0"/><Point x="1" y="0"/><Point x="0" y="1"/>'
        "</Obstacle></Obstacles>"
    )
    there = FILES / file
    found = imported(there if there.is_file() else tmp_path / file)
    assert document_of(found)["scenario"]["crowd"]["agents"]
    assert "crowd.agents" in notes(found, "added")


def test_agents_without_policies_take_presets() -> None:
    crowd = document_of(imported("agents.xml"))["scenario"]["crowd"]
    assert crowd["costs"]["ttca_dca"]["sigma_ttca"] == preset(1)["costs"]["ttca_dca"]["sigma_ttca"]
    assert PRESETS == (0, 1, 2)


def test_a_policy_that_is_not_there_is_an_error_at_its_place(tmp_path: Path) -> None:
    agents = tmp_path / "agents.xml"
    agents.write_text((FILES / "agents.xml").read_text().replace('Policy id="2"', 'Policy id="5"'))
    with pytest.raises(SpecError, match=r"agents.xml:10:13: error\[E402\] no policy 5; .* 1, 2"):
        imported(agents, "policies.xml")


def _as_xml(given: dict[str, Any], folder: Path) -> list[Path]:
    """A case of the original engine as its own files."""

    def element(tag: str, attributes: dict[str, Any], inner: str = "") -> str:
        expected = "".join(f' {name}="{value}"' for name, value in attributes.items())
        return f"<{tag}{expected}>{inner}</{tag}>"

    agents, policies, obstacles = "", "", ""
    for number, agent in enumerate(given["agents"]):
        known = ("rad", "pref_speed", "max_speed", "max_acceleration", "mass")
        places = "".join(
            element(tag, dict(zip("xy", agent.get(key, agent["pos"]), strict=True)))
            for tag, key in (("pos", "pos"), ("goal", "goal"))
        )
        used = agent.get("policy", given["policies"][0]["attrs"].get("id", 0))
        agents += element(
            "Agent", {"id": number, **{k: agent[k] for k in known if k in agent}},
            places + element("Policy", {"id": used}),
        )  # fmt: skip
    for number, policy in enumerate(given["policies"]):
        costs = "".join(element("costfunction", cost) for cost in policy["cost"])
        policies += element("Policy", {"id": number, **policy["attrs"]}, costs)
    for polygon in given.get("obstacles") or []:
        points = "".join(element("Point", {"x": x, "y": y}) for x, y in polygon)
        obstacles += element("Obstacle", {}, points)
    files = {"Agents": agents, "Policies": policies, "Obstacles": obstacles}
    for tag, inner in files.items():
        (folder / f"{tag}.xml").write_text(element(tag, {}, inner))
    return [folder / f"{tag}.xml" for tag, inner in files.items() if inner]


#: Cases of one method each: gradient, samples, random samples, closed form, walls.
_CASES = (
    "iso_TtcaDca_grad_six", "iso_RVO_sampling_obstacle", "iso_VanToll_global_six",
    "iso_ORCA_sampling_six", "samp_RVO_curr_unit_maxispe", "iso_SocialForcesAvoidance_grad_cross",
)  # fmt: skip


def one_step(files: list[Path], folder: Path, velocity: Any, dt: float) -> Any:
    """Places (N, 2) after one step of the imported crowd in the original's order, m."""
    found = imported(*files)
    path = write(folder / "case.yaml", found.lines, found.scenes)[0]
    scenario = open_spec(str(path), registry()).scenarios[0]
    people, crowd = population(scenario, registry()).agents, scenario.crowd
    parts = build_environment(registry(), scenario.environment)
    built = build_crowd(scenario, people, parts, registry())
    assert built is not None
    assert crowd is not None
    groups: list[Any] = [crowd, *(crowd.policies[name] for name in sorted(crowd.policies))]
    state = np.column_stack([people.x, people.y, np.broadcast_to(velocity, (len(people.x), 2))])
    case = Case(
        name="imported", dt=dt, states=state[np.newaxis], present=np.ones((1, len(state)), bool),
        agents=replace(built.agents, mass=np.ones(len(state))),
        goal=np.array([goals[0] for goals in people.goals]), walls=built.world.walls,
        periodic_boundary=built.world.periodic_boundary,
        policies=[(g.policy, list(g.costs.values())) for g in groups],
    )  # fmt: skip
    return Stepper(case).step(state)[:, :2]


@pytest.mark.parametrize("name", _CASES)
def test_one_step_is_that_of_the_original(name: str, tmp_path: Path) -> None:
    with np.load(FOLDER / f"{name}.npz") as data:
        state, given = np.asarray(data["state"], float), json.loads(str(data["settings"]))
    for agent, row in zip(given["agents"], state[0], strict=True):
        agent["pos"] = row[:2].tolist()
    moved = one_step(_as_xml(given, tmp_path), tmp_path, state[0][:, 2:], float(given["dt"]))
    assert moved == pytest.approx(state[1][:, :2], abs=1e-4)
