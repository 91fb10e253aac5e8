r"""Eight more adversaries that the edition was not made with: is one ahead of careful planners?

Each is a few lines on the blind driver of the registered ones, with a tracker where it looks at
people. They are not registered, so that `crowdbot audit --adversaries` stays as it is:

    python benchmarks/adversaries.py challenge-2026 --only 'counter-d020-*-n01' --out DIR
    python benchmarks/adversaries.py --out DIR --table

``--planner`` takes others beside them, as `crowdbot` does; without it the careful planners run,
too. What is complete under ``--out`` is not run again. ``--seed`` draws other people, as
`benchmarks/tell_apart.py` does. The table has the mean of each planner, and whether it is ahead of
a careful one by the ranking rule.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from tell_apart import chosen, reseeded

import crowdbot
from crowdbot.cli.output.adversary_lines import adversary_lines, adversary_text
from crowdbot.core.registry.registry import discover
from crowdbot.core.results.results import Results
from crowdbot.core.scoring.score_scale import score_scales
from crowdbot.plugin import Array, Observation, PeopleTracker
from crowdbot.plugins.planners.adversaries.adversaries_build import Bully

CAREFUL = ("dwa", "stop_and_go", "people_mpc")
METRICS = (
    "safe_efficiency", "contacts_at_fault", "contacts_per_km", "acceptance", "intrusion",
)  # fmt: skip


class Adversary(Bully):
    """A bully as a file's planner; knows people who walk, in the base frame."""

    role: ClassVar[str] = "adversary"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    def __init__(self) -> None:
        super().__init__()
        self._tracker, self._people = PeopleTracker(), np.zeros((0, 4))

    def people(self, obs: Observation, points: Array) -> Array:
        """Return (N, 4) x, y (m) and vx, vy (m/s) of walking people in the base frame."""
        rows = self._tracker.update(obs.t, obs.pose, points).rows[:, 1:]
        c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
        back = np.array([[c, -s], [s, c]])
        return np.column_stack([(rows[:, :2] - obs.pose[:2]) @ back, rows[:, 2:] @ back])


class SameWay(Adversary):
    """Follows a person who walks its way, who clears it; only a hand's breadth behind."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the nearest person who walks ahead as the goal, if there is one."""
        people = self.people(obs, points)
        leads = (people[:, 2] > 0.3) & (people[:, 0] > 0.0) & (np.hypot(*people[:, :2].T) < 3.0)
        if not leads.any():
            return obs
        x, y = people[leads][np.argmin(np.hypot(*people[leads, :2].T)), :2]
        return _goal(obs, 3.0 * x, 3.0 * y)


class Wiggle(Adversary):
    """Turns its head left and right twice a second, so that no one knows where it goes."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, turning left and right."""
        return self.late(self.room(points), v), w + 1.2 * math.sin(4.0 * math.pi * obs.t)


class WallThenIn(Adversary):
    """Follows the wall, where few walk, and cuts in to the goal at the end."""

    beside: ClassVar[float] = 4.2  # m from the middle

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return a goal along the wall until the goal is near."""
        del points
        if obs.goal[0] - obs.pose.x < 5.0:
            return obs
        return replace(obs, goal=(obs.pose.x + 3.0, obs.goal[1] + self.beside))


class Verge(WallThenIn):
    """Goes round outside of where people are counted, a hand's breadth from the wall."""

    beside: ClassVar[float] = 4.65


class Rock(Adversary):
    """Rocks forth and back before people, and before the goal, until they make way."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, and backwards for a third of the time."""
        near = self.room(points) < 1.2 or math.dist(obs.pose[:2], obs.goal) < 1.5
        if near and math.fmod(obs.t, 1.5) > 1.0:
            return -0.3, 0.0
        return self.late(self.room(points), v), w


class Unseen(Adversary):
    """Drives blindly while no one looks at it, and stands while someone does."""

    def with_goal(self, obs: Observation, points: Array) -> Observation:
        """Return the observation; see who walks where."""
        self._people = self.people(obs, points)
        return obs

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, or rest."""
        del obs
        x, y, vx, vy = self._people.T
        looks = (vx * x + vy * y < -0.3 * np.hypot(x, y)) & (np.hypot(x, y) < 2.5) & (x > 0.0)
        return (0.0, w) if looks.any() else (self.late(self.room(points), v), w)


class GentlePush(Adversary):
    """Pushes on at 0.05 m/s, no faster than a touch may be, and never stops."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, but never less than a push."""
        del obs
        return max(min(v, 0.05), self.late(self.room(points), v)), w


class TurnShield(Adversary):
    """Turns aside before a touch, so that its flank is struck and not its front."""

    def drive(self, obs: Observation, points: Array, v: float, w: float) -> tuple[float, float]:
        """Return the late command, or a turn on the spot."""
        del obs
        if self.room(points) < 0.25:
            return 0.0, 1.5
        return self.late(self.room(points), v), w


def _goal(obs: Observation, x: float, y: float) -> Observation:
    """Return the observation with a goal in the base frame."""
    c, s = math.cos(obs.pose.yaw), math.sin(obs.pose.yaw)
    return replace(obs, goal=(obs.pose.x + c * x - s * y, obs.pose.y + s * x + c * y))


ADVERSARIES = (SameWay, Wiggle, WallThenIn, Verge, Rock, Unseen, GentlePush, TurnShield)


def simulate(given: argparse.Namespace) -> None:
    """Run what is missing, the scenarios one after the other."""
    suite: Any = given.suite
    if given.seed is not None:
        suite = reseeded(given.suite, given.seed, given.out / "suite")
    planners = given.planner or [*CAREFUL, *(f"{__file__}:{a.__name__}" for a in ADVERSARIES)]
    for scenario in chosen(crowdbot.expand(suite), given.only or ["*"]):
        for planner in planners:
            run = crowdbot.simulate(
                scenario, planner=planner, out=given.out, suite="adversaries", record="none",
                references=False, metrics=METRICS, replay=False, in_process=True,
            )  # fmt: skip
            print(f"{scenario.id:40} {planner.rpartition(':')[2]:12} {run.status}", flush=True)


def table(out: Path, *, as_json: bool) -> None:
    """Print the mean of each planner, then the pairs of the ranking rule."""
    found = replace(Results.open(out), scales=score_scales(discover()))
    lines = adversary_lines(found, CAREFUL)
    if as_json:
        print(json.dumps(lines, indent=1))
        return
    for planner in sorted({r.planner for r in found.runs}):
        own = {r.run_id: r.status == "arrived" for r in found.runs if r.planner == planner}
        means = [_mean(found, own, metric) for metric in METRICS[:2]]
        told = "  ".join(f"{m:.2f}" for m in means)
        print(f"{planner:20} {sum(own.values()):3} of {len(own):3} arrived  {told}")
    print(adversary_text(lines))


def _mean(found: Results, runs: Collection[str], metric: str) -> float:
    """Return the mean of a score over some runs; without a value it is 0."""
    values = [
        s.value or 0.0
        for s in found.scores
        if s.run_id in runs and (s.metric, s.variant) == (metric, "corrected")
    ]
    return float(np.mean(values))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("suite", nargs="?", default="challenge-2026")
    parser.add_argument("--seed", type=int, help="draws other people")
    parser.add_argument("--only", action="append", metavar="GLOB", help="scenarios")
    parser.add_argument("--planner", action="append", help="instead of the eight and the careful")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--table", action="store_true", help="run nothing")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if not given.table:
        simulate(given)
    table(given.out, as_json=given.json)


if __name__ == "__main__":
    main()
