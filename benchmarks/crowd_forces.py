r"""The forces of people on a robot in each packaged crowd, and people's overlap with pillars.

A TurtleBot2 among people who walk both ways in a corridor with pillars, one run for each crowd and
each way of driving: parked in the middle, driven by a planner, driven blindly (`goal_seek`):

    python benchmarks/crowd_forces.py
    python benchmarks/crowd_forces.py --crowd rvo --robot goal_seek --seed 3 --seconds 60

Forces are those at each tick of 1/128 s: `all` is the 99th percentile over all ticks, `touching`
over those at which it is touched, `largest` the largest of them; `overlap` is how deep a body
was in a pillar at most, m, at 16 Hz. The last line of each robot counts crowds below --limit.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import crowdbot
from crowdbot.core.recording.container.records import Records, decode
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.named_crowds import crowd_parts
from crowdbot.core.types.arrays import Array

PARKED = "parked"
PLANNERS = {PARKED: "stand_still"}
#: x, y, radius, m.
PILLARS = [(x, y, 0.4) for x in (8.0, 14.0, 20.0) for y in (-1.6, 1.6)]
SCENARIO = """\
crowdbot: 1
scenario:
  id: {name}
  extends: [builtin:parts/turtlebot2.yaml, usual.yaml, "builtin:parts/crowds/{name}.yaml"]
  environment:
    kind: corridor
    length: 26 m
    width: 6 m
    pillars: {pillars}
    zones:
      crowd: {{x: [4 m, 24 m], y: [-3 m, 3 m]}}
      start: {{x: [0 m, 4 m], y: [-3 m, 3 m]}}
      goal: {{x: [24 m, 26 m], y: [-3 m, 3 m]}}
    portals:
      a: {{x: [-1 m, 0 m], y: [-3 m, 3 m]}}
      b: {{x: [26 m, 27 m], y: [-3 m, 3 m]}}
  robots.robot:
    sensors.force: {{kind: contact_force, force_max: 10000 N}}
    sensors.camera: null
    task:
      start: [{start} m, 0 m, 0 deg]
      goal: {{zone: goal}}
      time_limit: {seconds} s
  crowd:
    flow: {{direction: both, density: 0.3 1/m^2, area: crowd}}
    seed: {{root: {seed}}}
"""
#: Speeds of people in corridors, where a crowd has none of its own.
USUAL = "crowd.speed: {mean: 1.34 m/s, std: 0.26 m/s}\n"


@dataclass(frozen=True)
class Felt:
    """What one run came to: forces (N), number of contacts, depth in pillars (m), its ending."""

    everywhere: float
    touching: float
    largest: float
    contacts: int
    overlap: float
    status: str

    def line(self) -> str:
        """Return it as columns."""
        forces = f"{self.everywhere:6.0f} {self.touching:8.0f} {self.largest:8.0f}"
        return f"{forces} {self.contacts:8} {self.overlap:8.3f} {self.status}"


def measure(name: str, how: str, seconds: float, seed: int, changes: list[str]) -> Felt:
    """Simulate one run."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        (folder / "usual.yaml").write_text(USUAL, encoding="utf-8")
        pillars = {f"p{k}": {"x": x, "y": y, "radius": r} for k, (x, y, r) in enumerate(PILLARS)}
        start = 14.0 if how == PARKED else 1.5
        text = SCENARIO.format(name=name, pillars=pillars, start=start, seconds=seconds, seed=seed)
        (folder / "forces.yaml").write_text(text, encoding="utf-8")
        scenario = crowdbot.load(folder / "forces.yaml", name, set=changes)
        run = crowdbot.simulate(
            scenario, planner=PLANNERS.get(how, how), record="all", references=False,
            replay=False, metrics="contact_time", out=folder / "runs",
        )  # fmt: skip
        return _felt(run, forces_of(run.directory / "run.mcap"))


def forces_of(path: Path) -> Array:
    """Return the force at each tick of a run, N."""
    found = []
    for record in Records(path):
        if record.msgtype == "geometry_msgs/msg/WrenchStamped":
            force: Any = decode(path, record).wrench.force
            found.append(float(np.hypot(force.x, force.y)))
    return np.array(found)


def _felt(run: crowdbot.Run, forces: Array) -> Felt:
    tracks = run.trajectories
    felt = forces[forces > 0.0]
    people, contacts = tracks.agents, tracks.contacts
    assert people is not None
    assert contacts is not None
    depths = [people.radius + r - np.hypot(people.x - x, people.y - y) for x, y, r in PILLARS]
    return Felt(
        everywhere=float(np.percentile(forces, 99.0)),
        touching=float(np.percentile(felt, 99.0)) if len(felt) else 0.0,
        largest=float(np.max(felt, initial=0.0)),
        contacts=int(np.sum(contacts.agent >= 0)),
        overlap=float(np.nanmax(np.array(depths), initial=0.0)),
        status=run.status,
    )


def main() -> None:
    registry = discover()
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--crowd", action="append", help="all packaged ones")
    parser.add_argument(
        "--robot", action="append", help="parked, or a planner: parked, dwa, goal_seek"
    )
    parser.add_argument("--seconds", type=float, default=50.0)
    parser.add_argument("--seed", type=int, default=0, help="draws other people")
    parser.add_argument("--set", action="append", default=[], help="as of crowdbot simulate")
    parser.add_argument("--limit", type=float, default=300.0, help="N")
    given = parser.parse_args()
    names = given.crowd or sorted(n for n in crowd_parts(registry) if ":" not in n)
    for how in given.robot or [PARKED, "dwa", "goal_seek"]:
        print(f"{how:24}    all touching  largest contacts  overlap")
        found = []
        for name in names:
            found.append(measure(name, how, given.seconds, given.seed, given.set))
            print(f"{name:24} {found[-1].line()}", flush=True)
        columns = zip(*((f.everywhere, f.touching, f.largest) for f in found), strict=True)
        below = [sum(force < given.limit for force in column) for column in columns]
        print(f"below {given.limit:g} N: {below} of {len(found)} crowds (all, touching, largest)")


if __name__ == "__main__":
    main()
