r"""What people do about a robot: are they hit, how hard do they dodge, and what does it cost?

Runs the challenge's crowds at the real time steps, without Drake, with one robot that is moved as
told:

- ``parked`` stands;
- ``blind`` drives along the corridor and sees nobody;
- ``careful`` drives, and is slowed down to a stop by whoever is in front of it.

    python benchmarks/robot_response.py --robot parked --only '*-d0500-fast-c20-r05' --at 25,0
    python benchmarks/robot_response.py --robot blind --robot careful --only 'counter-*-c20-r05'
    python benchmarks/robot_response.py --cost --only 'counter-d0500-*-c20-r05'
    python benchmarks/robot_response.py --robot blind --robot careful --robot parked --effect \
        --seconds 60 --suite challenge-2026 --only 'counter-d040-*-n0[1-3]'

A peak is the largest acceleration of one person, from velocities at 16 Hz, while within 2 m of the
robot. There are two: *visits*, one for each visit on which the person does not touch the robot,
whatever else pushes him; and *own legs*, one for each person and run, over the steps on which
nothing touches him, neither robot nor wall nor anybody else. The second is what `corrected` of the
metric `evasive_acceleration` is made of, and what the limits of 4 m/s^2, and 5 in dense and fast
crowds, are for: 95 % of the peaks of all runs together are below the number that is printed.
``alone`` is the same without a robot: what the crowd does anyway.
``--cost`` compares the processor time of the crowd with each response with that of people who
ignore the robot, in turns. ``--effect`` shows E_v, the mean speed of people without the robot
over that with it, from their velocities at 16 Hz, and its interval of 95 % over scenarios.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatch

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND
from crowdbot.core.trajectories.evasion import evasion, own_legs
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.dsl.scenario.scenario import Scenario

Array = NDArray[np.float64]
BODY = 0.178  # radius of the challenge's robot, m
FASTEST, ACCELERATION = 0.65, 1.0  # of the challenge's robot, m/s and m/s^2
LENGTH = 45.0  # where a driving robot has arrived, m
STEP = 8  # ticks from one command to the next: 16 Hz
NEAR, GONE = 2.0, 4.0  # where a person's acceleration counts, and where a visit has ended, m
MASS, JUMP = 6.3, 10.0  # of the robot, kg; a faster step is a teleport, m/s
COSTS = {  # name: kind and reaction
    "human": ("human", "yield"),
    "giving_way": ("giving_way", "yield"),
    "ignore": ("human", "ignore"),
}


@dataclass
class Visits:
    """Peaks of people's acceleration beside the robot, one for each visit without a touch."""

    count: int
    peaks: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._peak, self._touches = np.zeros(self.count), np.zeros(self.count)
        self._last = np.full((self.count, 4), np.nan)

    def add(self, people: Array, touch: Array, robot: Array) -> None:
        """One sample of 16 Hz; ``touch`` (N, T) are contacts with the robot."""
        now = people[:, [s.X, s.Y, s.VX, s.VY]].copy()
        moved = now - self._last
        jumped = ~(np.hypot(moved[:, 0], moved[:, 1]) < 0.5) | (people[:, s.WAITING] != s.PRESENT)
        away = np.hypot(now[:, 0] - robot[0], now[:, 1] - robot[1])
        beside = (away < NEAR) & ~jumped
        acceleration = np.hypot(moved[:, 2], moved[:, 3]) * TICKS_PER_SECOND / STEP
        self._peak[beside] = np.maximum(self._peak, acceleration)[beside]
        touches = touch[:, s.TOUCHES] + touch[:, s.TOUCHING]
        self._peak[touches > self._touches] = -math.inf
        ended = (away > GONE) | jumped
        self.peaks += self._peak[ended & (self._peak > 0.0)].tolist()
        self._peak[ended] = 0.0
        self._touches[ended] = touches[ended]
        self._last = now

    def percentile(self, q: float) -> float:
        """Of the peaks, m/s^2."""
        return float(np.percentile(self.peaks, q)) if self.peaks else math.nan


@dataclass
class Outcome:
    """What one run came to."""

    hits: int
    seconds: float
    gap: float
    visits: Visits
    speed: float  # mean of people, m/s
    legs: list[float]  # largest acceleration of each person who is met, by own legs, m/s^2


@dataclass
class Samples:
    """Everybody's motion at 16 Hz, for what the metrics say of it."""

    radius: Array
    walls: Array
    robot: list[Array] = field(default_factory=list)
    people: list[Array] = field(default_factory=list)
    touching: list[Array] = field(default_factory=list)

    def add(self, people: Array, touch: Array, robot: Array) -> None:
        """One sample; who is not there is nowhere."""
        now = people[:, [s.X, s.Y, s.VX, s.VY]].copy()
        now[people[:, s.WAITING] != s.PRESENT] = np.nan
        self.people.append(now)
        self.robot.append(robot[:4].copy())
        self.touching.append(touch[:, s.TOUCHES] + 0.5 * touch[:, s.TOUCHING])

    def peaks(self) -> list[float]:
        """Of each person who is met: the largest acceleration while nothing touches him, m/s^2."""
        if len(self.robot) < 2:
            return []
        x, y, vx, vy = np.moveaxis(np.array(self.people), 2, 0)
        rx, ry, rvx, rvy = np.array(self.robot).T
        still, touches = np.zeros(len(rx)), np.array(self.touching)
        run = Trajectories.from_arrays(
            t=np.arange(len(rx)) * STEP * TICK, walls=self.walls, robot_x=rx, robot_y=ry,
            robot_theta=still, robot_vx=rvx, robot_vy=rvy, robot_w=still, robot_radius=BODY,
            robot_mass=MASS, agent_x=x, agent_y=y, agent_vx=vx, agent_vy=vy,
            agent_radius=self.radius, agent_mass=np.full(len(self.radius), 75.0),
        )  # fmt: skip
        # Who touches it at the end of the step, or has begun or ended to do so since its beginning.
        hit = (touches[1:] != touches[:-1]) | (np.mod(touches[1:], 1.0) != 0.0)
        own = own_legs(run, NEAR, JUMP) & ~hit
        size = np.where(own, evasion(run, NEAR, JUMP).size, 0.0).max(axis=0)
        return [float(peak) for peak in size[own.any(axis=0)]]


def name_of(scenario: Scenario) -> str:
    """Labels of the matrix, without the suite and what ``--set`` appends."""
    return scenario.id.rpartition("/")[2].partition("+")[0]


def engine_of(scenario: Scenario) -> CrowdEngine:
    registry = discover()
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    return engine


def command(how: str, robot: Array, people: Array, radius: Array) -> float:
    """Speed that the robot is told, m/s; a careful one can stop short of those in its way."""
    if how in ("parked", "alone"):
        return 0.0
    if how == "blind":
        return FASTEST
    dx, dy = people[:, s.X] - robot[0], people[:, s.Y] - robot[1]
    half = np.abs(dy) - BODY - 0.15
    ahead = (dx > 0.0) & (half < radius) & (people[:, s.WAITING] == s.PRESENT)
    across = np.maximum(np.abs(dy[ahead]) - BODY - 0.15, 0.0)
    front = dx[ahead] - np.sqrt(radius[ahead] ** 2 - across**2)
    room = float(np.min(front, initial=9.0)) - BODY - 0.35
    return 0.0 if room <= 0.0 else min(FASTEST, math.sqrt(0.04 + 2.0 * room) - 0.2)


def run(
    engine: CrowdEngine, how: str, at: Sequence[float], seconds: float, margin: float
) -> Outcome:
    """One robot among the people of an engine, who are moved off its start first."""
    flat = engine.initial_state()
    (_, people), (felt, touches) = s.view(flat), s.contact_with(flat)
    near = np.hypot(people[:, s.X] - at[0], people[:, s.Y] - at[1]) < 1.0
    people[near, s.WAITING] = s.AT_PORTAL
    robot = np.array([[at[0], at[1], 0.0, 0.0, BODY, BODY + margin, 0.0, 0.0]])
    shown = robot if how != "alone" else robot[:0]
    visits, gap, speed = Visits(len(people)), math.inf, 0.0
    samples = Samples(engine.agents.radius, engine.world.walls)
    walked = count = 0.0
    ticks = round(seconds * TICKS_PER_SECOND)
    for tick in range(ticks):
        if tick % STEP == 0:
            change = command(how, robot[0], people, engine.agents.radius) - speed
            most = ACCELERATION * STEP * TICK
            speed += max(-most, min(most, change))
            robot[0, 2] = speed
            visits.add(people, touches, robot[0])
            samples.add(people, touches, robot[0])
            here = people[:, s.WAITING] == s.PRESENT
            walked += float(np.hypot(people[here, s.VX], people[here, s.VY]).sum())
            count += float(here.sum())
        engine.advance(flat, shown)
        robot[0, 0] += speed * TICK
        here = people[:, s.WAITING] == s.PRESENT
        away = np.hypot(people[here, s.X] - robot[0, 0], people[here, s.Y] - robot[0, 1])
        gap = min(gap, float(np.min(away - engine.agents.radius[here], initial=9.0)) - BODY)
        if robot[0, 0] > LENGTH:
            break
    hits = int(felt[s.CONTACTS] + np.sum(touches[:, s.TOUCHING]))
    return Outcome(hits, (tick + 1) * TICK, gap, visits, walked / count, samples.peaks())


def cost(engine: CrowdEngine, seconds: float, margin: float) -> float:
    """Processor time of a parked robot's crowd, s."""
    flat = engine.initial_state()
    robot = np.array([[25.0, 0.0, 0.0, 0.0, BODY, BODY + margin, 0.0, 0.0]])
    began = time.process_time()
    for _ in range(round(seconds * TICKS_PER_SECOND)):
        engine.advance(flat, robot)
    return time.process_time() - began


def costs(name: str, overrides: list[str], seconds: float) -> None:
    """Print what the response costs beside people who ignore it: the best of five turns each."""
    registry, best = discover(), dict.fromkeys(COSTS, math.inf)
    engines = {}
    for how, (kind, reaction) in COSTS.items():
        response = f"crowd.robot_response={{kind: {kind}, reaction: {reaction}}}"
        words = [*overrides, response]
        suite = open_spec("challenge-2020", registry, words)
        engines[how] = engine_of(next(x for x in suite.scenarios if name_of(x) == name))
        cost(engines[how], 1.0, 0.25)
    for _ in range(5):
        for how, engine in engines.items():
            best[how] = min(best[how], cost(engine, seconds, 0.25))
    human, ignore = best["human"], best["ignore"]
    print(
        f"{name:32} {human / seconds * 1e3:6.1f} ms a second: {human / ignore:.3f} of ignore; "
        f"giving_way {best['giving_way'] / human:.3f} of human", flush=True,
    )  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robot", action="append", help="alone, parked, blind or careful")
    parser.add_argument("--suite", default="challenge-2020")
    parser.add_argument("--set", action="append", default=[], help="as of crowdbot simulate")
    parser.add_argument("--only", action="append", help="pattern of scenario ids")
    parser.add_argument("--seconds", type=float, help="180; parked and --cost 60")
    parser.add_argument("--at", action="append", help="x,y of the robot at the start; 2.5,0")
    parser.add_argument("--effect", action="store_true", help="compare with nobody's robot")
    parser.add_argument("--cost", action="store_true", help="measure processor time instead")
    given = parser.parse_args()
    places = [tuple(map(float, text.split(","))) for text in given.at or ["2.5,0"]]
    robots = [*(["alone"] if given.effect else []), *(given.robot or ["parked"])]
    total: dict[str, list[Outcome]] = {how: [] for how in robots}
    for scenario in open_spec(given.suite, discover(), given.set).scenarios:
        name = name_of(scenario)
        if not any(fnmatch(name, pattern) for pattern in given.only or ["*"]):
            continue
        if given.cost:
            costs(name, given.set, given.seconds or 60.0)
            continue
        assert scenario.crowd is not None
        engine, margin = engine_of(scenario), scenario.crowd.robot_response.margin
        for how, found in total.items():
            limit = given.seconds or (60.0 if how in ("parked", "alone") else 180.0)
            for at in places:
                found.append(run(engine, how, at, limit, margin))
                print(f"{name:32} {at!s:12} {how:8} {line(found[-1:])}", flush=True)
    for how, found in total.items():
        if found:
            print(f"{len(found):4} runs {'':35} {how:8} {line(found)}")
            if given.effect and how != "alone":
                print(f"{how:8} E_v {effect(total['alone'], found)}")


def effect(alone: Sequence[Outcome], found: Sequence[Outcome]) -> str:
    """The mean of E_v over runs, and 1.96 standard errors on either side."""
    ratios = np.array([a.speed / b.speed for a, b in zip(alone, found, strict=True)])
    half = 1.96 * ratios.std(ddof=1) / math.sqrt(len(ratios)) if len(ratios) > 1 else math.nan
    return f"{ratios.mean():.4f} [{ratios.mean() - half:.4f}, {ratios.mean() + half:.4f}]"


def line(found: Sequence[Outcome]) -> str:
    """Some runs for people."""
    hits, gap = [one.hits for one in found], min(one.gap for one in found)
    visits = peaks_line([peak for one in found for peak in one.visits.peaks])
    legs = peaks_line([peak for one in found for peak in one.legs])
    return (
        f"{sum(hits):3} hits in {sum(h > 0 for h in hits)} runs, least gap {gap:6.3f} m, "
        f"{np.mean([one.seconds for one in found]):5.1f} s, m/s^2: {visits} visits; own legs {legs}"
    )


def peaks_line(peaks: Sequence[float]) -> str:
    """Median and 95 % of some peaks, and how many there are."""
    p50, p95 = np.percentile(peaks or [math.nan], [50, 95])
    return f"median {p50:.1f}, 95 % {p95:.1f} of {len(peaks)}"


if __name__ == "__main__":
    main()
