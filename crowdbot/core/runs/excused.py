"""Excused runs: a robot that topples after being struck without its fault gets another draw."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.runs import provenance
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.record_parts import ExcusedPart
from crowdbot.core.trajectories.fault.struck_over import struck_over
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.ending import Ending
from crowdbot.dsl.scenario.scenario import Scenario


def excuse_of(
    outcome: Outcome, runs: Mapping[str, Trajectories], realisation: str, draw: int
) -> ExcusedPart | None:
    """Return why a run is not counted; None if it is.

    Args:
        outcome: how it ended.
        runs: runs of its robots, to the end.
        realisation: hash of its people.
        draw: number of the draw, 0 for the scenario's own.
    """
    if outcome.status != Ending.TOPPLED or outcome.toppled_time is None or len(runs) != 1:
        return None
    run = next(iter(runs.values()))
    struck = struck_over(run, outcome.toppled_time)
    if struck is None or run.agents is None:
        return None
    return ExcusedPart(
        draw=draw,
        person=int(run.agents.id[struck.agent]),
        struck_time=round(struck.t, 6),
        toppled_time=outcome.toppled_time,
        realisation=realisation,
        trajectory=provenance.trajectory_hash(run),
    )


def with_draw(scenario: Scenario, draw: int) -> Scenario:
    """Return a scenario with the people of another draw; draw 0 is the scenario's own."""
    if not draw or scenario.crowd is None:
        return scenario
    seed = scenario.crowd.seed
    other = seed.model_copy(update={"key": f"{seed.key}/again-{draw}"})
    return scenario.model_copy(
        update={
            "crowd": scenario.crowd.model_copy(update={"seed": other}),
            "references": {n: with_draw(s, draw) for n, s in scenario.references.items()},
        }
    )
