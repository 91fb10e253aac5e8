"""Robot and person as two discs under the contact law, integrated by scipy; no code of ours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
ROBOT_RADIUS, PERSON_RADIUS = 0.178, 0.33


@dataclass(frozen=True)
class Meeting:
    """Robot and person before they touch: positions (m) and velocities (m/s), masses (kg)."""

    robot: tuple[float, float]
    robot_v: tuple[float, float]
    person_v: tuple[float, float]
    robot_mass: float = 6.3
    person_mass: float = 75.0
    stiffness: float = 30000.0
    dissipation: float = 0.3


@dataclass(frozen=True)
class Outcome:
    """Of one contact: impulse (N s), peak force (N), duration (s), velocities after it (m/s).

    ``dissipated`` is the integral of the law's damping part times the closing rate, J.
    """

    impulse: float
    peak: float
    duration: float
    robot_v: Array
    person_v: Array
    dissipated: float


def contact(m: Meeting) -> Outcome:
    """From touch to parting, both found as roots; the person starts at the origin."""
    reach = ROBOT_RADIUS + PERSON_RADIUS

    def gap(_: float, y: Array) -> float:
        return float(np.hypot(*(y[0:2] - y[4:6]))) - reach

    def law(y: Array) -> tuple[float, float, Array]:
        """Force, its damping part times the closing rate, and the normal."""
        n = (y[0:2] - y[4:6]) / np.hypot(*(y[0:2] - y[4:6]))
        depth, closing = max(0.0, -gap(0.0, y)), -float((y[2:4] - y[6:8]) @ n)
        force = max(0.0, m.stiffness * depth * (1.0 + m.dissipation * closing))
        return force, (force - m.stiffness * depth) * closing, n

    def rate(_: float, y: Array) -> Array:
        force, loss, n = law(y)
        return np.concatenate(
            (y[2:4], force * n / m.robot_mass, y[6:8], -force * n / m.person_mass, [force, loss])
        )

    start = np.array([*m.robot, *m.robot_v, 0.0, 0.0, *m.person_v, 0.0, 0.0])
    gap.terminal, gap.direction = True, -1  # type: ignore[attr-defined]
    options = {"events": gap, "rtol": 1e-10, "atol": 1e-12}
    before = solve_ivp(rate, (0.0, 10.0), start, max_step=0.05, **options)
    gap.direction = 1  # type: ignore[attr-defined]
    touching = solve_ivp(rate, (0.0, 2.0), before.y[:, -1], max_step=2e-4, **options)
    assert len(touching.t_events[0]) == 1
    end = touching.y[:, -1]
    return Outcome(
        impulse=float(end[8]),
        peak=max(law(y)[0] for y in touching.y.T),
        duration=float(touching.t[-1]),
        robot_v=end[2:4],
        person_v=end[6:8],
        dissipated=float(end[9]),
    )
