"""The Python API: what the commands do, for scripts and notebooks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.dsl.expand import Expansion
from crowdbot.dsl.scenario import Scenario

if TYPE_CHECKING:
    from crowdbot.core.results.rows import Results
    from crowdbot.core.runs.outcome import Progress
    from crowdbot.core.runs.request import Recorded, Run
    from crowdbot.core.scoring.evaluate import MetricParameters, Scores
    from crowdbot.core.trajectories.commands import Commands
    from crowdbot.core.trajectories.questionnaires import Questionnaires
    from crowdbot.core.trajectories.trajectories import Trajectories


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
    *,
    planner: str = "dwa",
    planner_settings: Sequence[str] = (),
    seed: int = 0,
    out: str | Path | None = None,
    suite: str = "scenarios",
    record: Recorded = "all",
    references: bool = True,
    force: bool = False,
    metrics: str | Sequence[str] = "*",
    replay: bool = True,
    step_budget: float | None = None,
    in_process: bool | None = None,
    planner_memory: float | None = 4.0,
    progress: Callable[[Progress], None] | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> Run:
    """Simulate, record and score one run; a complete run with the same hashes is reused.

    Args:
        scenario: from `load` or `expand`.
        planner: kind, YAML file or ``file.py:Class``.
        planner_settings: ``key=value`` texts that change its parameters.
        seed: of the run: sensor noise and planner.
        out: root of the run directories; None uses a temporary folder that lives as long as the
            result.
        suite: name of the first folder below ``out``.
        record: which sensors are simulated and recorded: ``all``; ``used``, those that the
            planner reads; ``none``, only what scores need.
        references: whether the calibration runs are made where they are missing.
        force: whether a complete run is made again.
        metrics: one or several globs over metric names.
        replay: whether the replay page is written.
        step_budget: wall time that a planner step may take, s; None: any.
        in_process: whether the planner runs inside this process, where a debugger sees it and
            nothing contains it; None: crowdbot's own do, all others have a process of their own.
        planner_memory: largest address space of its own process, GiB; None: any.
        progress: called several times a simulated second.
        stop: asked several times a simulated second; True ends the run.

    Raises:
        InputError: the scenario has no robot, the planner, the folder or an option is wrong, or
            the lock of the suite does not fit it any more.
        UnknownNameError: no metric answers to a pattern.
        PlannerHungError: a planner step never returned; a ``.partial`` directory is left.
        Interrupted: ``stop`` returned True; a ``.partial`` directory is left.
    """
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.core.sim.simulate import simulate as simulate_it

    memory = None if planner_memory is None else round(planner_memory * 2**30)
    return simulate_it(
        scenario,
        registry(),
        planner=planner,
        planner_settings=planner_settings,
        seed=seed,
        out=None if out is None else Path(out),
        suite=suite,
        record=record,
        references=references,
        force=force,
        metrics=_patterns(metrics),
        replay=replay,
        step_budget=step_budget,
        place=PlannerPlace(in_process=in_process, memory=memory),
        progress=progress,
        stop=stop,
    )


def _patterns(metrics: str | Sequence[str]) -> Sequence[str] | None:
    """What a record says of the metrics; None is all of them."""
    if metrics == "*":
        return None
    return [metrics] if isinstance(metrics, str) else metrics


def evaluate(run: Run, metrics: str | Sequence[str] = "*") -> Scores:
    """Score a run again from its recording.

    Args:
        run: from `simulate`.
        metrics: one or several globs over metric names.

    Raises:
        UnknownNameError: no metric answers to a pattern.
        InputError: its recording cannot be read.
        PluginError: a metric failed.
    """
    refs = run.references
    return score(run.trajectories, refs.robot_alone, refs.crowd_alone, metrics=metrics)


def score(
    crowded: Trajectories | None = None,
    robot_alone: Trajectories | None = None,
    crowd_alone: Trajectories | None = None,
    *,
    commands: Commands | None = None,
    commands_baseline: Commands | None = None,
    questionnaires: Questionnaires | Mapping[str, object] | None = None,
    metrics: str | Sequence[str] = "*",
    variants: str | Sequence[str] = "all",
    parameters: MetricParameters | None = None,
) -> Scores:
    """Score trajectories, commands and answers, of crowdbot or of anybody else.

    Args:
        crowded: the run; None where only commands or answers are known.
        robot_alone: the same robot without people, where known.
        crowd_alone: the same people without robot, where known.
        commands: the user's and the final commands.
        commands_baseline: commands of a drive of the same user without shared control.
        questionnaires: answers; see `Questionnaires.from_mapping`.
        metrics: one or several globs over metric names; each must match.
        variants: ``all``, or the names of the variants to keep.
        parameters: metric -> field -> value; what is left out keeps its default.

    Raises:
        UnknownNameError: no metric or variant answers to a name.
        InputError: there is nothing to score, a metric is retired, or a value does not fit.
        PluginError: a metric failed.
    """
    from crowdbot.core.scoring.evaluate import score as score_it

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
    """All runs, scores and failures below a folder, as a campaign leaves them.

    Args:
        root: of the run directories.

    Raises:
        InputError: there is no such folder, or a run in it is damaged.
    """
    from crowdbot.core.results.store import load as load_results

    return load_results(Path(root))
