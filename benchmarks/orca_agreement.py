r"""Do our half-planes choose the velocities of navground's ORCA?

Closed cases of a disc of 0.3 m that drives at 0.65 m/s and wants to go on, then random scenes of
up to seven people who do not touch it:

    python benchmarks/orca_agreement.py --scenes 2000

Needs ``crowdbot[navground]``. The last column is the difference of both velocities, m/s.
"""

from __future__ import annotations

import argparse
import importlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugins.planners.orca.orca_build import half_planes
from crowdbot.plugins.planners.shared.half_planes_build import best_velocity

Array = NDArray[np.float64]
RADIUS, TOP, HORIZON, OBSTACLE_HORIZON = 0.3, 0.65, 2.0, 1.0
OWN = WISH = (TOP, 0.0)
#: Name, people (x, y, vx, vy, radius), what stands (x, y).
CASES: tuple[tuple[str, list[list[float]], list[list[float]]], ...] = (
    ("free", [], []),
    ("head on", [[2.0, 0.1, -0.65, 0.0, 0.3]], []),
    ("head on, exactly", [[2.0, 0.0, -0.65, 0.0, 0.3]], []),
    ("crossing", [[1.5, -1.5, 0.0, 0.8, 0.3]], []),
    ("overtaking", [[1.2, 0.05, 0.3, 0.0, 0.3]], []),
    ("two who come", [[2.0, 0.3, -0.65, 0.0, 0.3], [2.0, -0.5, -0.4, 0.0, 0.3]], []),
    ("a person who stands", [[1.2, 0.1, 0.0, 0.0, 0.3]], []),
    ("a thing that stands", [], [[0.9, 0.1]]),
)


def ours(people: list[list[float]], points: list[list[float]], own: Any = OWN) -> Array:
    """Our velocity, m/s."""
    lines, scratch = np.zeros((400, 4)), np.zeros((400, 4))
    hard, count = half_planes(
        np.array(points, dtype=float).reshape(-1, 2), np.array(people, dtype=float).reshape(-1, 5),
        (0.0, 0.0), tuple(own), (HORIZON, OBSTACLE_HORIZON, 0.5), RADIUS, lines,
    )  # fmt: skip
    return np.array(best_velocity(lines, count, hard, TOP, WISH, scratch))


def theirs(people: list[list[float]], points: list[list[float]], own: Any = OWN) -> Array:
    """The velocity of navground, m/s."""
    core = importlib.import_module("navground.core")
    behavior = core.Behavior.make_type("ORCA")
    behavior.kinematics = core.kinematics.OmnidirectionalKinematics(TOP, 10.0)
    behavior.radius, behavior.horizon, behavior.optimal_speed = RADIUS, 20.0, TOP
    behavior.time_horizon = HORIZON
    behavior.position, behavior.orientation, behavior.velocity = (0.0, 0.0), 0.0, tuple(own)
    state = behavior.environment_state
    state.neighbors = [
        core.Neighbor((x, y), r, (vx, vy), n) for n, (x, y, vx, vy, r) in enumerate(people, 1)
    ]
    state.static_obstacles = [core.Disc((x, y), 0.03) for x, y in points]
    behavior.target = core.Target(direction=(1.0, 0.0), speed=TOP)
    behavior.compute_cmd(0.25)
    return np.asarray(behavior.desired_velocity, dtype=np.float64)


def scenes(count: int, seed: int = 0) -> list[tuple[list[list[float]], tuple[float, float]]]:
    """People, none of whom touches the robot, and its velocity."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        n = int(rng.integers(1, 8))
        angle, away = rng.uniform(0.0, 2.0 * np.pi, n), rng.uniform(0.7, 4.0, n)
        going = rng.normal(0.0, 0.5, (n, 2))
        people = np.column_stack(
            [away * np.cos(angle), away * np.sin(angle), going, np.full(n, 0.3)]
        )
        u, v = rng.uniform(-0.4, 0.4, 2).tolist()
        found.append((people.tolist(), (u, v)))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=2000)
    given = parser.parse_args()
    print(f"{'case':22}{'ours':>18}{'navground':>18}{'difference':>12}")
    for name, people, points in CASES:
        a, b = ours(people, points), theirs(people, points)
        both = "".join(f"   ({v[0]:6.3f}, {v[1]:6.3f})" for v in (a, b))
        print(f"{name:22}{both}{np.hypot(*(a - b)):12.4f}")
    off = [np.hypot(*(ours(p, [], own) - theirs(p, [], own))) for p, own in scenes(given.scenes)]
    print(
        f"{given.scenes} random scenes: median {np.median(off):.1e}, largest {np.max(off):.1e} m/s"
    )


if __name__ == "__main__":
    main()
