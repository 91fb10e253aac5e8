"""People who overlap at the start: other simulators allow it, crowdbot does not.

They keep their positions and enter a few milliseconds apart, within the first tick; the simulated
contact then pushes them apart.
"""

from __future__ import annotations

from crowdbot.core.exchange.report import Report, Trace
from crowdbot.core.exchange.rows import PartOutcome
from crowdbot.core.exchange.scene import USUAL_RADIUS, Draft
from crowdbot.dsl.checks.agents import Disc, overlapping

#: Time between two that overlap, s.
_LATER = 1e-3
_NOTE = "overlaps another at the start, which is not allowed here: enters some milliseconds later"


def enter_in_turn(scene: Draft, report: Report) -> None:
    """Delay agents who overlap others that enter at the same time; record each."""
    radius = scene.crowd.get("body", {}).get("radius", USUAL_RADIUS)
    waves: dict[float, list[int]] = {}
    for number, agent in enumerate(scene.agents):
        waves.setdefault(agent.get("start_time", 0.0), []).append(number)
    for begin, wave in waves.items():
        discs = {n: _disc(scene, n, radius) for n in wave}
        turn = 0
        while wave:
            late = {wave[k] for _, k in overlapping([discs[n] for n in wave])}
            if turn:
                for number in (n for n in wave if n not in late):
                    _delay(scene, report, number, round(begin + turn * _LATER, 6))
            wave = [number for number in wave if number in late]
            turn += 1


def _disc(scene: Draft, number: int, radius: float) -> Disc:
    agent = scene.agents[number]
    return agent["x"], agent["y"], agent.get("radius", radius)


def _delay(scene: Draft, report: Report, number: int, time: float) -> None:
    path = ("crowd", "agents", str(number))
    place = scene.origins.get(path)
    report.entries.append(
        Trace(PartOutcome.INTERPRETED, "start", place, "crowd.agents.start_time", _NOTE)
    )
    scene.comments[path] = "overlaps another: enters some milliseconds later"
    scene.agents[number]["start_time"] = time
