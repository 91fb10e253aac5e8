"""What is worth knowing of a scenario before it is run, as text."""

from __future__ import annotations

import numpy as np

from crowdbot.core.population.realisation import Realisation
from crowdbot.dsl.scenario import Scenario


def scenario_facts(scenario: Scenario, people: Realisation, spec_hash: str) -> dict[str, str]:
    """Name -> text: counts, density, speeds, time limit, hashes."""
    facts = {"title": scenario.title} if scenario.title else {}
    facts["people"] = str(len(people))
    flow = scenario.crowd.flow if scenario.crowd is not None else None
    if flow is not None:
        facts["density"] = f"{flow.density:g} 1/m² in {flow.area} at the start"
        facts["flow"] = flow.direction
    if len(people):
        low, high = float(people.speed.min()), float(people.speed.max())
        facts["speeds"] = f"{low:.2f}–{high:.2f} m/s, mean {float(people.speed.mean()):.2f}"
    groups = len(np.unique(people.group[people.group >= 0]))
    if groups:
        facts["groups"] = str(groups)
    later = int(np.count_nonzero(people.start_time > 0))
    if later:
        facts["entering later"] = str(later)
    for name, robot in scenario.robots.items():
        facts[name] = f"{robot.model.kind}, {robot.task.time_limit:g} s"
    facts["spec"] = spec_hash
    if len(people):
        facts["agents"] = people.hash
    return facts
