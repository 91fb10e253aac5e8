"""Facts about a scenario before it is run, as text."""

from __future__ import annotations

from collections import Counter

import numpy as np

from crowdbot.core.population.realisation import Realisation
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.stream import Stream


def scenario_facts(scenario: Scenario, people: Realisation, spec_hash: str) -> dict[str, str]:
    """Return name -> text: counts, density, speeds, time limit, hashes."""
    facts = {"title": scenario.title} if scenario.title else {}
    facts["people"] = str(len(people))
    flow = scenario.crowd.flow if scenario.crowd is not None else None
    if flow is not None:
        facts["density"] = f"{flow.density:g} 1/m² in {flow.area} at the start"
        facts["flow"] = flow.direction
    for name, stream in sorted(scenario.crowd.streams.items()) if scenario.crowd else ():
        facts[f"stream {name}"] = _stream(stream)
    if len(people):
        low, high = float(people.speed.min()), float(people.speed.max())
        facts["speeds"] = f"{low:.2f}–{high:.2f} m/s, mean {float(people.speed.mean()):.2f}"
    groups = len(np.unique(people.group[people.group >= 0]))
    if groups:
        facts["groups"] = str(groups)
    looks = Counter(look for look in people.look if look)
    if looks:
        facts["looks"] = ", ".join(f"{n} {look}" for look, n in sorted(looks.items()))
    later = int(np.count_nonzero(people.start_time > 0))
    if later:
        facts["entering later"] = str(later)
    for name, robot in scenario.robots.items():
        facts[name] = f"{robot.model.kind}, {robot.task.time_limit:g} s"
    facts["spec"] = spec_hash
    if len(people):
        facts["agents"] = people.hash
    return facts


def _stream(stream: Stream) -> str:
    """Describe pattern and number of a stream of people."""
    density, arrivals = stream.people_per_area, stream.entering
    if density is not None:
        return f"{stream.kind}, {density:g} 1/m²"
    if arrivals is None:
        return f"{stream.kind}, {stream.count}"
    if arrivals.rate is not None:
        return f"{stream.kind}, {arrivals.rate:g} 1/s at random"
    every = f"one every {arrivals.every:g} s" if arrivals.every else f"{len(arrivals.times)} times"
    return f"{stream.kind}, {every}"
