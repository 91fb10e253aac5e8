"""Repeat runs of the reference scores, and compare their trajectories bit by bit."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from crowdbot.core.bundle.rerun_verdict import same_platform
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.identity import prepare
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.lock_check import spec_of
from crowdbot.core.sim.simulate import make_run
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import InputError

#: ``changed``: the scenario or the planner is another one here.
Remade = Literal["identical", "different", "different_platform", "changed"]
_METRICS = ("success",)


@dataclass(frozen=True, slots=True, kw_only=True)
class RemakeSetup:
    """Registry and callbacks for repeating runs, as in `Request`."""

    registry: Registry
    progress: Callable[[Progress], None] | None = None
    stop: Callable[[], bool] = lambda: False


def sample_of(runs: Sequence[RunRow], size: int | None, seed: int) -> list[RunRow]:
    """Return a random sample of the runs by a seed; all if ``size`` is None."""
    if size is None or size >= len(runs):
        return list(runs)
    rng = random.Random(stream_seed(seed, "references", "verify.sample"))
    return [runs[n] for n in sorted(rng.sample(range(len(runs)), size))]


def remake(setup: RemakeSetup, run: RunRow) -> Remade:
    """Repeat a run; return how its trajectory relates to the reference.

    Raises:
        CrowdbotError: it cannot be simulated.
    """
    expansion = open_spec(run.suite, setup.registry)
    scenario = next((s for s in expansion.scenarios if s.id == run.scenario), None)
    planner = run.record.planner
    choice = resolve_planner(planner.kind, setup.registry)
    if scenario is None or spec_of(scenario, setup.registry) != run.spec_hash:
        return "changed"
    if choice.label != planner.label:
        raise InputError(f"{planner.label}: only planners with defaults are references")
    with tempfile.TemporaryDirectory(prefix="crowdbot-references-") as folder:
        request = Request(
            scenario=scenario, choice=choice, registry=setup.registry, seed=run.seed,
            out=Path(folder), entry=expansion.entry(scenario),
            options=RunOptions(record="none", replay=False, references=False, metrics=_METRICS),
            progress=setup.progress, stop=setup.stop,
        )  # fmt: skip
        record = make_run(request, prepare(scenario, setup.registry, references=False)).record
    if record.hashes.trajectory == run.trajectory_hash:
        return "identical"
    if record.planner != planner:
        return "changed"
    return "different" if same_platform(run.record, record) else "different_platform"
