"""Write the replay page of an episode."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from crowdbot.core.batch.world import BatchWorld
from crowdbot.core.replay.page import write_replay
from crowdbot.core.replay.shown_run import ShownRun
from crowdbot.core.robots.look import seen_from_above
from crowdbot.core.runs.replayed import scenery
from crowdbot.core.runs.solids import SolidPeople, solids_of
from crowdbot.core.sensing.appearance_model import heights
from crowdbot.core.types.score import Score
from crowdbot.rl.episode_log import EpisodeLog


def episode_page(path: Path, world: BatchWorld, log: EpisodeLog, scores: Sequence[Score]) -> None:
    """Write the page.

    Args:
        world: of the episode.
        log: its samples.
        scores: shown beside it.

    Raises:
        InputError: the path cannot be written.
    """
    plan, run = world.blueprint, log.trajectories()
    (name,), (model,) = plan.names, plan.models
    arrival = "—" if log.goal_time is None else f"{log.goal_time:.2f} s"
    draw = "of the suite" if world.root is None else str(world.root)
    write_replay(
        path,
        ShownRun(
            run=run,
            title=f"{plan.scenario.id} · episode",
            facts={
                "Scenario": plan.scenario.id,
                "Draw of people": draw,
                "Status": log.ending(),
                "Arrived at": arrival,
            },
            scores=scores,
            look=[(part.outline, part.colour) for part in seen_from_above(model)],
            robot=name,
            scenery=scenery(plan.parts, model.height),
            solids=solids_of(plan.parts, {name: (model, {})}, _people(world)),
        ),
    )


def _people(world: BatchWorld) -> SolidPeople | None:
    """Return the bodies of the people; None without any."""
    engine, crowd = world.engine, world.blueprint.scenario.crowd
    if engine is None or crowd is None or not len(engine.agents):
        return None
    looks = engine.agents.looks
    if looks is None:
        return SolidPeople(height=np.array([crowd.body.height]))
    return SolidPeople(height=heights(looks, crowd.body.height), look=looks.look)
