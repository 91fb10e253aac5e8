"""The Python API: the commands' functions, for scripts and notebooks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, overload

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.support.arguments import expect, number_of, path_of, texts_of
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.settings import setting_texts
from crowdbot.dsl.suite.suite_entry import SuiteEntry
from crowdbot.errors import InputError, kind_of

if TYPE_CHECKING:
    from crowdbot.core.planning.given_planner import GivenPlanner
    from crowdbot.core.results.results import Results
    from crowdbot.core.runs.outcome import Progress
    from crowdbot.core.runs.run import Run
    from crowdbot.core.runs.run_options import Recorded
    from crowdbot.core.scoring.evaluate import MetricParameters, Scores
    from crowdbot.core.trajectories.commands import Commands
    from crowdbot.core.trajectories.questionnaires import Questionnaires
    from crowdbot.core.trajectories.trajectories import Trajectories


def _draw(scenario: Scenario) -> str:
    from crowdbot.core.view.notebook import scenario_html

    return scenario_html(scenario)


#: Drawing is above the language in the layers; notebooks find it here.
Scenario.draw_html = _draw

#: A suite of the scenario language, its scenarios expanded.
Suite = Expansion
#: Changes to a scenario: ``key=value``, several of them, or a mapping.
Overrides = str | Sequence[str] | Mapping[str, object]


@cache
def registry() -> Registry:
    """Return the installed plugins, discovered once per process."""
    return discover()


@overload
def load(path_or_name: str | Path, scenario: str, *, set: Overrides = ...) -> Scenario: ...
@overload
def load(
    path_or_name: str | Path, scenario: None = ..., *, set: Overrides = ...
) -> Suite | Scenario: ...
def load(
    path_or_name: str | Path, scenario: str | None = None, *, set: Overrides = ()
) -> Suite | Scenario:
    """Read a suite, or one scenario of it.

    Args:
        path_or_name: a file, or the name of a packaged suite.
        scenario: id, unique prefix or pattern; None: the suite, or the only scenario of a document.
        set: changes to every scenario, as ``--set`` of the commands: ``"crowd.flow.density=0.3"``
            or a list of such texts, or a mapping ``{"crowd.flow.density": 0.3}``. The ids get a
            suffix.

    Raises:
        SpecError: the document, or a change to it, is wrong.
        UnknownNameError: no such suite or scenario.
        InputError: an argument has the wrong type.
    """
    expect("path_or_name", path_or_name, str, Path)
    if scenario is not None:
        expect("scenario", scenario, str)
    expansion = open_spec(str(path_or_name), registry(), setting_texts(set))
    if scenario is not None:
        return pick(expansion, scenario)
    return expansion.scenarios[0] if expansion.single else expansion


def expand(suite: Suite | Scenario | str | Path, *, set: Overrides = ()) -> list[Scenario]:
    """Return all scenarios of a suite, in order.

    Args:
        suite: from `load`; or a file or name, which is loaded.
        set: as for `load`; only if the suite is loaded here.

    Raises:
        SpecError: the document, or a change to it, is wrong.
        UnknownNameError: no such suite.
        InputError: it is not a suite, or ``set`` was given with a loaded suite.
    """
    if isinstance(suite, str | Path):
        suite = load(suite, set=set)
    elif set:
        raise InputError("set changes what is loaded: give it to load, or a name to expand")
    if isinstance(suite, Scenario):
        return [suite]
    if not isinstance(suite, Expansion):
        raise InputError(f"suite must be a file, a name or a Suite, not {kind_of(suite)}")
    return list(suite.scenarios)


def simulate(
    scenario: Scenario,
    *,
    planner: GivenPlanner = "dwa",
    planner_settings: Sequence[str] | Mapping[str, object] = (),
    seed: int = 0,
    out: str | Path | None = None,
    suite: str = "scenarios",
    record: Recorded = "used",
    references: bool = True,
    force: bool = False,
    metrics: str | Sequence[str] = "*",
    replay: bool = True,
    step_budget: float | None = None,
    duration: float | None = None,
    in_process: bool | None = None,
    planner_memory: float | None = 4.0,
    progress: Callable[[Progress], None] | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> Run:
    """Simulate, record and score one run; a complete run with the same hashes is reused.

    Args:
        scenario: from `load` or `expand`.
        planner: kind, YAML file or ``file.py:Class``; a class with ``reset`` and ``step``, or an
            instance of one; a function from an observation to a command; or the spec of a kind.
            Runs of an object or a function are never reused, since its state may have changed.
        planner_settings: ``key=value`` texts, or a mapping, that change its parameters.
        seed: seed of sensor noise and planner.
        out: root of the run directories; None uses a temporary folder that lives as long as the
            result.
        suite: name of the first folder below ``out``.
        record: which sensors are simulated and recorded: ``used``: those that the planner reads, as
            shown on the replay page; ``all``: every reading; ``none``: only data for scores.
        references: True to run missing calibration runs.
        force: True to repeat a complete run.
        metrics: one or several globs over metric names.
        replay: True to write the replay page.
        step_budget: largest wall time of a planner step, s; None: unlimited.
        duration: of a scenario without a robot, whose people walk alone, s; None: 60.
        in_process: True: run the planner in this process, visible to a debugger but not isolated;
            None: only crowdbot's own planners, all others in separate processes.
        planner_memory: largest address space of its process, GiB; None: unlimited.
        progress: called several times per simulated second.
        stop: called several times per simulated second; True ends the run.

    Raises:
        InputError: there is neither robot nor people; planner, folder or an option is wrong, or the
            suite's lock is out of date.
        UnknownNameError: no metric matches a pattern.
        PlannerHungError: a planner step never returned; a ``.partial`` directory is left.
        Interrupted: ``stop`` returned True; a ``.partial`` directory is left.
    """
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.core.runs.run_options import RunOptions
    from crowdbot.core.sim.simulate import simulate as simulate_it

    expect("scenario", scenario, Scenario, hint="crowdbot.load(SUITE, ID) reads one")
    if in_process is not None:
        expect("in_process", in_process, bool)
    return simulate_it(
        scenario,
        registry(),
        planner=planner,
        planner_settings=planner_settings,
        seed=seed,
        out=None if out is None else path_of("out", out),
        entry=SuiteEntry(suite=suite),
        options=RunOptions(
            record=record,
            replay=replay,
            references=references,
            force=force,
            metrics=_patterns(metrics),
            step_budget=step_budget,
            duration=duration,
            place=PlannerPlace(in_process=in_process, memory=_bytes(planner_memory)),
        ),
        progress=progress,
        stop=stop,
    )


def _patterns(metrics: str | Sequence[str]) -> Sequence[str] | None:
    """Return metric patterns for the run record; None for ``"*"``, which selects all."""
    if metrics == "*":
        return None
    return texts_of("metrics", metrics)


def _bytes(planner_memory: float | None) -> int | None:
    """Return the address space of a planner's process in bytes, from GiB.

    Raises:
        InputError: it is not a positive number.
    """
    if planner_memory is None:
        return None
    memory = number_of("planner_memory", planner_memory, "GiB")
    if memory <= 0.0:
        raise InputError(f"planner_memory must be positive, in GiB, not {memory:g}")
    return round(memory * 2**30)


def evaluate(run: Run | str | Path, metrics: str | Sequence[str] = "*") -> Scores:
    """Score a run again from its recording.

    Args:
        run: from `simulate`, or its directory.
        metrics: one or several globs over metric names.

    Raises:
        UnknownNameError: no metric matches a pattern.
        InputError: it is not a run, or its recording cannot be read.
        PluginError: a metric failed.
    """
    from crowdbot.core.runs.run import Run as RunOnDisk

    made = RunOnDisk.open(run) if isinstance(run, str | Path) else run
    expect("run", made, RunOnDisk, hint="crowdbot.simulate returns one")
    refs = made.references
    scores = score(made.trajectories, refs.robot_alone, refs.crowd_alone, metrics=metrics)
    return replace(scores, scenario=made.scenario, planner=made.planner, seed=made.seed)


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
    """Score trajectories, commands and answers, from crowdbot or other sources.

    Args:
        crowded: the run; None if only commands or answers are known.
        robot_alone: the same robot without people, if known.
        crowd_alone: the same people without robot, if known.
        commands: the user's and the final commands.
        commands_baseline: commands of a drive of the same user without shared control.
        questionnaires: answers; see `Questionnaires.from_mapping`.
        metrics: one or several globs over metric names; each must match.
        variants: ``all``, or the names of the variants to keep.
        parameters: metric -> field -> value; others keep their defaults.

    Raises:
        UnknownNameError: no metric or variant has a given name.
        InputError: there is nothing to score, a metric is retired, or a value is invalid.
        PluginError: a metric failed.
    """
    from crowdbot.core.scoring.evaluate import score as score_it

    _check_recorded(crowded, robot_alone, crowd_alone, commands, commands_baseline)
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


def results(root: str | Path = "runs", *, altered: bool = False) -> Results:
    """Return all runs, scores and failures below a folder, as written by a campaign.

    Args:
        root: root of the run directories.
        altered: True to include runs of scenarios that ``set`` changed.

    Raises:
        InputError: there is no such folder, or a run in it is damaged.
    """
    from crowdbot.core.results.results import Results as AllResults

    all_results = AllResults.open(root)
    return all_results if altered else all_results.without_altered()


def _check_recorded(
    crowded: object,
    robot_alone: object,
    crowd_alone: object,
    commands: object,
    commands_baseline: object,
) -> None:
    """Refuse arguments that are not trajectories or commands.

    Raises:
        InputError: an argument has another type.
    """
    from crowdbot.core.trajectories.commands import Commands as SomeCommands
    from crowdbot.core.trajectories.trajectories import Trajectories as SomeTrajectories

    runs = {"crowded": crowded, "robot_alone": robot_alone, "crowd_alone": crowd_alone}
    for name, value in runs.items():
        if value is not None:
            hint = (
                "Trajectories.from_csv, from_arrays and others make them; a run has .trajectories"
            )
            expect(name, value, SomeTrajectories, hint=hint)
    given = {"commands": commands, "commands_baseline": commands_baseline}
    for name, value in given.items():
        if value is not None:
            expect(name, value, SomeCommands, hint="Commands.from_arrays makes them")
