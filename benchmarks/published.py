r"""Do published results about robots among people come out in crowdbot?

Each command is one publication: it runs what it needs, prints numbers with intervals of 95 %, and
says ``agrees`` or ``does not agree``. What counts as agreement is fixed here, before any run:

    python benchmarks/published.py who-gives-way
    python benchmarks/published.py what-is-hard --out /tmp/hard
    python benchmarks/published.py effect-on-people --out /tmp/hard
    python benchmarks/published.py legible --out /tmp/hard

``what-is-hard`` and ``effect-on-people`` share their runs; what is complete is not run again.
docs/developers/published_results.md says what came out.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import spearmanr

import crowdbot
from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICK
from crowdbot.dsl.scenario.scenario import Scenario

Array = NDArray[np.float64]
SUITES = Path(__file__).parent / "published"
#: Planners among people who look at the robot, and among people who ignore it.
PLANNERS = {
    "look": ("orca", "rds", "social_force", "mppi"),
    "ignore": ("orca", "social_force", "mppi"),
}
DENSITIES = {"density_005": 0.05, "density_015": 0.15, "density_025": 0.25, "density_035": 0.35}
WIDTHS = {"width_2": 2.0, "density_015": 4.0, "width_6": 6.0, "width_8": 8.0}
RESAMPLES = 2_000
#: A planner that is less far aside has not steered, m (rms).
LEAST_ASIDE = 0.01


class Interval(NamedTuple):
    """A value and its interval of 95 %."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3f} [{self.low:.3f}, {self.high:.3f}]"


def resampled(rows: Array, statistic: Callable[[Array], float]) -> Interval:
    """Return a statistic of rows, which are draws of people, and its percentile interval."""
    drawn = np.random.default_rng(0).integers(0, len(rows), (RESAMPLES, len(rows)))
    low, high = np.nanpercentile([statistic(rows[index]) for index in drawn], [2.5, 97.5])
    return Interval(statistic(rows), float(low), float(high))


# --------------------------------------------------------------------------- who gives way

#: Where ways cross, m; the robot's radius, and what people keep from it, m.
CROSSING, ROBOT_RADIUS, MARGIN = (7.0, 7.0), 0.3, 0.25
#: Speeds of the robot, m/s.
ROBOT_SPEEDS = (0.65, 1.0, 1.5)
#: How far the robot is from the crossing when the person would be there, m: it is late by that.
LATE = np.linspace(0.1, 1.0, 10)


def name_of(scenario: Scenario) -> str:
    """Return a scenario's labels, as ``look-density_005-n01``."""
    return scenario.id.rpartition("/")[2]


def engine_of(scenario: Scenario) -> CrowdEngine:
    """Return the engine of a scenario's people."""
    registry = discover()
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    return engine


def alone(engine: CrowdEngine) -> float:
    """Return when the person, alone, is at the crossing, s."""
    flat = engine.initial_state()
    (_, people), tick = s.view(flat), 0
    while people[0, s.Y] < CROSSING[1]:
        engine.advance(flat, np.zeros((0, 8)))
        tick += 1
    return tick * TICK


def passes_first(engine: CrowdEngine, there: float, late: float, speed: float) -> bool:
    """Return True if the person crosses the robot's line before the robot crosses theirs.

    The person walks north along x = 7 m. When alone they are at the crossing after ``there`` s, at
    which a robot that drives east at a constant speed is ``late`` m short of it.
    """
    flat = engine.initial_state()
    (_, people), x = s.view(flat), CROSSING[0] - late - speed * there
    wide = ROBOT_RADIUS + MARGIN
    robot = np.array([[x, CROSSING[1], speed, 0.0, ROBOT_RADIUS, wide, 0.0, 0.0]])
    while robot[0, 0] < CROSSING[0]:
        engine.advance(flat, robot)
        robot[0, 0] += speed * TICK
        if people[0, s.Y] > CROSSING[1]:
            return True
    return False


def who_gives_way(_: argparse.Namespace) -> bool:
    """Vassallo et al. 2017: people let a passive robot pass, even if they would be first."""
    found: dict[tuple[str, float], list[list[bool]]] = {}
    for scenario in crowdbot.expand(SUITES / "crossing.yaml"):
        engine, name = engine_of(scenario), name_of(scenario).rpartition("-")[0]
        there = alone(engine)
        for speed in ROBOT_SPEEDS:
            first = [passes_first(engine, there, float(late), speed) for late in LATE]
            found.setdefault((name, speed), []).append(first)
    print("share of people who pass first although they may, by metres by which the robot is late:")
    print(f"{'response':12} {'robot':>8}" + "".join(f"{late:6.1f}" for late in LATE))
    giving = {}
    for (name, speed), rows in found.items():
        shares = "".join(f"{share:6.2f}" for share in np.mean(rows, axis=0))
        giving[name, speed] = resampled(np.array(rows), lambda r: 1.0 - float(np.mean(r)))
        print(f"{name:12} {speed:4} m/s{shares}   give way: {giving[name, speed]}")
    held = True
    for speed in ROBOT_SPEEDS:
        most = giving["giving_way", speed].low > 0.5
        held &= verdict(f"most people give way to a robot at {speed} m/s", most)
    return held


# --------------------------------------------------------------------------- campaigns of ours


def run_all(
    out: Path, suite: str, prefix: str, planners: Sequence[str]
) -> dict[tuple[str, str], list[dict[str, float]]]:
    """Run what is missing; return level and planner -> numbers of its draws.

    Args:
        out: root of the run directories.
        suite: name of a file beside this one; its last axis but the draw is the level.
        prefix: how labels begin.
        planners: kinds.
    """
    found: dict[tuple[str, str], list[dict[str, float]]] = {}
    metrics = ["success_no_collision", "effect_on_velocity"]
    every = crowdbot.expand(SUITES / f"{suite}.yaml")
    scenarios = [one for one in every if name_of(one).startswith(prefix)]
    for count, scenario in enumerate(scenarios):
        level = name_of(scenario).split("-")[-2]
        for planner in planners:
            run = crowdbot.simulate(
                scenario, planner=planner, out=out, suite=suite.replace("_", "-"), record="none",
                metrics=metrics, replay=False, in_process=True,
            )  # fmt: skip
            found.setdefault((level, planner), []).append(numbers(run))
        print(f"\r{count + 1} of {len(scenarios)} scenarios", end="", file=sys.stderr)
    print(file=sys.stderr)
    return found


def numbers(run: crowdbot.Run) -> dict[str, float]:
    """Return the numbers of a run that are compared."""
    robot, t, goal = run.trajectories.robot, run.trajectories.t, run.trajectories.goal_zone
    assert robot is not None
    assert goal is not None
    aside = robot.y - robot.y[0]
    # A point that goes straight to where the goal begins, at the robot's largest speed.
    speed = run.trajectories.robot_speed_limit
    assert speed is not None
    there = np.minimum(speed * t, goal[:, 0].min() - robot.x[0])
    effect = run.scores.find("effect_on_velocity").value
    return {
        "success": float(run.scores.find("success_no_collision").value or 0.0),
        "aside": float(np.sqrt(np.mean(aside**2))),
        "error": float(np.mean(np.hypot(robot.x - robot.x[0] - there, aside))),
        "effect": math.nan if effect is None else float(effect),
    }


def column(found: Mapping[tuple[str, str], list[dict[str, float]]], levels: Sequence[str],
           planners: Sequence[str], name: str) -> Array:  # fmt: skip
    """Return numbers (draws, levels, planners)."""
    return np.moveaxis(
        np.array([[[row[name] for row in found[(level, planner)]] for planner in planners]
                  for level in levels]), 2, 0,
    )  # fmt: skip


def what_is_hard(given: argparse.Namespace) -> bool:
    """Stratton et al. 2024: success falls with density (rho -0.88), rises with width (0.64)."""
    held = True
    for people, planners in PLANNERS.items():
        found = run_all(given.out, "narrow_and_dense", f"{people}-", planners)
        for factor, levels, sign in (("density", DENSITIES, -1), ("width", WIDTHS, 1)):
            table = column(found, list(levels), planners, "success")
            for k, planner in enumerate(planners):
                pairs = zip(levels.values(), table[:, :, k].mean(axis=0), strict=True)
                shown = ", ".join(f"{value:g}: {mean:.2f}" for value, mean in pairs)
                print(f"people {people:7} success by {factor:8} {planner:13} {shown}")
            estimate = resampled(table, partial(rank_correlation, np.array([*levels.values()])))
            claim = f"people {people}: rho of {factor} and success {estimate}"
            held &= verdict(claim, min(sign * estimate.low, sign * estimate.high) > 0.0)
    return held


def rank_correlation(values: Array, table: Array) -> float:
    """Return Spearman's rho of levels and success, over levels and planners; 0 if all succeed."""
    cells = table.mean(axis=0)
    repeated = np.repeat(values, cells.shape[1])
    return float(spearmanr(repeated, cells.ravel()).statistic) if np.ptp(cells) else 0.0


def effect_on_people(given: argparse.Namespace) -> bool:
    """Gonon et al. 2021: RDS keeps to its course better than ORCA; neither slows people down."""
    print("a round robot:")
    held = rds_and_orca(run_all(given.out, "narrow_and_dense", "look-", ("rds", "orca")))
    print("a long robot:")
    return rds_and_orca(run_all(given.out, "long_robot", "", ("rds", "orca"))) and held


def rds_and_orca(found: Mapping[tuple[str, str], list[dict[str, float]]]) -> bool:
    """Compare both planners in all levels."""
    levels = sorted({level for level, _ in found})
    pair, held = ("rds", "orca"), True
    for k, planner in enumerate(pair):
        rates = column(found, levels, pair, "success")[:, :, k].mean(axis=0)
        shown = zip(levels, rates, strict=True)
        print(f"success of {planner}: " + ", ".join(f"{level} {rate:.2f}" for level, rate in shown))
    # A robot that drives straight and only brakes, as a blind one does, keeps to its course best.
    steers = column(found, levels, ("rds",), "aside").mean() > LEAST_ASIDE
    how = "" if steers else ", but rds drives straight on: nothing shown"
    for name, what in (("aside", "its course (rms)"), ("error", "a point that goes on")):
        both = column(found, levels, pair, name).mean(axis=1)
        print(f"away from {what}: rds {both[:, 0].mean():.3f} m, orca {both[:, 1].mean():.3f} m")
        gap = resampled(both[:, 1] - both[:, 0], lambda rows: float(np.mean(rows)))
        held &= verdict(
            f"rds is nearer to {what} than orca by {gap} m{how}", steers and gap.low > 0
        )
    effects = np.nanmean(column(found, levels, ("rds", "orca"), "effect"), axis=1)
    for k, planner in enumerate(("rds", "orca")):
        estimate = resampled(effects[:, k], lambda rows: float(np.nanmean(rows)))
        held &= verdict(f"E_v of {planner}: {estimate}", abs(estimate.value - 1.0) < 0.03)
    return held


# --------------------------------------------------------------------------- legible

#: People this near to the robot are compared, m; time over which velocities are taken, s.
BESIDE, LOOK = 3.0, 0.25


def acceleration_beside(run: crowdbot.Run) -> float:
    """Return the mean acceleration of people beside the robot, m/s^2; nan if no one is."""
    found = run.trajectories
    assert found.robot is not None
    assert found.agents is not None
    step = float(found.t[1] - found.t[0])
    k = max(1, round(LOOK / step))
    x, y = np.asarray(found.agents.x), np.asarray(found.agents.y)
    size = np.hypot(*((a[2 * k :] - 2 * a[k:-k] + a[: -2 * k]) / (k * step) ** 2 for a in (x, y)))
    away = np.hypot(x - found.robot.x[:, None], y - found.robot.y[:, None])[k:-k]
    return float(np.mean(size[away < BESIDE])) if (away < BESIDE).any() else math.nan


def legible(given: argparse.Namespace) -> bool:
    """Mavrogiannis et al. 2019: people accelerate less beside Social Momentum than beside ORCA."""
    planners = ("social_momentum", "orca", "goal_seek")
    rows = []
    for scenario in crowdbot.expand(SUITES / "stations.yaml"):
        runs = [
            crowdbot.simulate(scenario, planner=planner, out=given.out, suite="stations",
                              record="none", metrics=["success_no_collision"], replay=False,
                              in_process=True)
            for planner in planners
        ]  # fmt: skip
        rows.append([acceleration_beside(run) for run in runs])
        print(f"\r{len(rows)} draws", end="", file=sys.stderr)
    print(file=sys.stderr)
    table = np.array(rows)
    for k, planner in enumerate(planners):
        estimate = resampled(table[:, k], lambda column: float(np.nanmean(column)))
        print(f"acceleration of people beside {planner}: {estimate} m/s^2")
    less = resampled(table[:, 1] - table[:, 0], lambda column: float(np.nanmean(column)))
    return verdict(f"less beside social_momentum than beside orca by {less} m/s^2", less.low > 0.0)


def verdict(claim: str, holds: bool) -> bool:
    """Print a claim and its verdict."""
    print(f"{'agrees' if holds else 'does not agree'}: {claim}")
    return holds


COMMANDS: dict[str, Callable[[argparse.Namespace], bool]] = {
    "who-gives-way": who_gives_way,
    "what-is-hard": what_is_hard,
    "effect-on-people": effect_on_people,
    "legible": legible,
}


def main() -> int:
    """Run one comparison; exit with 1 if it does not agree."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result", choices=COMMANDS)
    parser.add_argument("--out", type=Path, default=Path("runs"), help="root of run directories")
    given = parser.parse_args()
    return 0 if COMMANDS[given.result](given) else 1


if __name__ == "__main__":
    sys.exit(main())
