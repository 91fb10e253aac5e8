"""The Python API: what the commands do, for scripts and notebooks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crowdbot.core.library import open_spec, pick
from crowdbot.core.registry import Registry, discover
from crowdbot.dsl.expand import Expansion
from crowdbot.dsl.scenario import Scenario

if TYPE_CHECKING:
    from crowdbot.core.commands import Commands
    from crowdbot.core.evaluate import MetricParameters, Scores
    from crowdbot.core.questionnaires import Questionnaires
    from crowdbot.core.results.rows import Results
    from crowdbot.core.sim.outcome import Progress
    from crowdbot.core.sim.request import Run
    from crowdbot.core.trajectory import Trajectories


@cache
def registry() -> Registry:
    """The installed plugins, discovered once in a process."""
    return discover()


def load(path_or_name: str | Path, scenario: str | None = None) -> Expansion | Scenario:
    """Read a suite, or one scenario of it.

    Args:
        path_or_name: a file, or the name of a packaged suite.
        scenario: id, unique prefix or pattern; None gives the suite, or the scenario of a
            document that holds one.

    Raises:
        SpecError: the document is wrong.
        UnknownNameError: no such suite or scenario.
    """
    expansion = open_spec(str(path_or_name), registry())
    if scenario is not None:
        return pick(expansion, scenario)
    return expansion.scenarios[0] if expansion.single else expansion


def expand(suite: Expansion) -> list[Scenario]:
    """All scenarios of a suite, in order."""
    return list(suite.scenarios)


def simulate(
    scenario: Scenario,
    planner: str = "dwa",
    seed: int = 0,
    out: str | Path | None = None,
    progress: Callable[[Progress], None] | None = None,
    **options: Any,
) -> Run:
    """Simulate, record and score one run; see `crowdbot.core.sim.simulate.simulate`."""
    from crowdbot.core.sim.simulate import simulate as simulate_it

    return simulate_it(
        scenario,
        registry(),
        planner=planner,
        seed=seed,
        out=None if out is None else Path(out),
        progress=progress,
        **options,
    )


def evaluate(run: Run, metrics: str | Sequence[str] = "*") -> Scores:
    """Score a run again from its recording."""
    refs = run.references
    return score(run.trajectories, refs.robot_alone, refs.crowd_alone, metrics=metrics)


def score(
    crowded: Trajectories | None = None,
    robot_alone: Trajectories | None = None,
    crowd_alone: Trajectories | None = None,
    commands: Commands | None = None,
    commands_baseline: Commands | None = None,
    questionnaires: Questionnaires | Mapping[str, Any] | None = None,
    metrics: str | Sequence[str] = "*",
    variants: str | Sequence[str] = "all",
    parameters: MetricParameters | None = None,
) -> Scores:
    """Score trajectories, commands and answers; see `crowdbot.core.evaluate.score`."""
    from crowdbot.core.evaluate import score as score_it

    return score_it(
        registry(),
        crowded,
        robot_alone,
        crowd_alone,
        commands,
        commands_baseline,
        questionnaires,
        metrics,
        variants,
        parameters,
    )


def results(root: str | Path = "runs") -> Results:
    """All runs, scores and failures of a campaign; see `crowdbot.core.results.store.load`."""
    from crowdbot.core.results.store import load as load_results

    return load_results(Path(root))
