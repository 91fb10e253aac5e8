"""The nonlinear program of the MPC: velocities in equal stages, and their costs.

Residuals are squared and summed. A plan is single shooting: velocities are the variables, their
limits and slew are linear constraints, and poses follow from them. Distances to people and walls
are soft constraints with quadratic slack. CasADi differentiates; the Hessian is that of Gauss and
Newton, so that each quadratic program is convex.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.plugin import Array, RobotLimits
from crowdbot.plugins.planners.mpc.mpc import MpcSpec

#: Parameters before those of obstacles: x, y, yaw, v, w, vy, waypoint x and y, largest speed.
STATE = 9
#: Columns of an obstacle: of people x, y, of half-planes the normal's; place of the robot's disc
#: in its frame; least distance of people, m, or of the plane from the origin.
COLUMNS = 5
_EPS = 1e-6
_SOLVER = "daqp"


class Problem:
    """The program, built in `reset`; solved in each step from a starting plan.

    Args:
        casadi: the library.
        spec: parameters.
        limits: the robot's.

    Attributes:
        dt: length of a stage, s.
        axes: 2 (v, w) or 3 (and vy).
    """

    def __init__(self, casadi: Any, spec: MpcSpec, limits: RobotLimits) -> None:
        self.limits, self._stages = limits, spec.stages
        self.dt = spec.horizon / spec.stages
        self.axes = 3 if limits.vy_max > 0.0 else 2
        plan = casadi.SX.sym("plan", spec.stages, self.axes)
        slots = spec.stages * (spec.neighbours + spec.planes) * COLUMNS
        given = casadi.SX.sym("given", STATE + slots)
        z = casadi.vec(plan)
        residuals = _residuals(casadi, spec, plan, given, self.dt)
        jacobian = casadi.jacobian(residuals, z)
        hessian = jacobian.T @ jacobian + _EPS * casadi.SX.eye(z.numel())
        cost = 0.5 * casadi.sumsqr(residuals)
        before = casadi.vertcat(given[[3, 4, 5][: self.axes]].T, plan[:-1, :])
        names = ["x", "p", "lam_f", "lam_g"]
        change = casadi.vec(plan - before)
        extra = [casadi.SX.sym("f"), casadi.SX.sym("g", change.numel())]
        gauss_newton = casadi.Function(
            "gauss_newton", [z, given, *extra], [hessian], names, ["hess_gamma_x_x"]
        )
        self._cost = casadi.Function("cost", [z, given], [cost])
        self._solver = casadi.nlpsol(
            "mpc", "sqpmethod", {"x": z, "p": given, "f": cost, "g": change},
            {"qpsol": _SOLVER, "qpsol_options": {"error_on_fail": False},
             "max_iter": spec.iterations, "hess_lag": gauss_newton, "error_on_fail": False,
             "print_header": False, "print_iteration": False, "print_status": False,
             "print_time": False},
        )  # fmt: skip
        slew = [limits.a_max, limits.alpha_max, limits.a_max][: self.axes]
        self._slew = np.repeat(np.array(slew) * self.dt, spec.stages)

    def cost(self, plan: Array, given: Array) -> float:
        """Return the cost of a plan (N, 2 or 3)."""
        return float(self._cost(plan.ravel(order="F"), given))

    def solve(self, plan: Array, given: Array) -> tuple[Array, float] | None:
        """Return a better plan and its cost; None if the solver fails.

        Args:
            plan: (N, 2 or 3) v, w and perhaps vy, to start from.
            given: parameters.
        """
        low, high = self._bounds(given)
        start = np.clip(plan.ravel(order="F"), low, high)
        try:
            found = self._solver(
                x0=start, p=given, lbx=low, ubx=high, lbg=-self._slew, ubg=self._slew
            )
        except RuntimeError:
            return None
        z = np.array(found["x"]).ravel()
        if not np.isfinite(z).all() or (z < low - 0.05).any() or (z > high + 0.05).any():
            return None
        better = np.clip(z, low, high).reshape(plan.shape, order="F")
        return better, float(found["f"])

    def _bounds(self, given: Array) -> tuple[Array, Array]:
        """Return the least and largest velocities, which the robot can reach in each stage."""
        limits, ahead = self.limits, np.arange(1, self._stages + 1) * self.dt
        lows = [0.0, -limits.w_max, -limits.vy_max]
        highs = [given[8], limits.w_max, min(limits.vy_max, given[8])]
        lows[2] = -highs[2]
        if self.axes == 3:
            lows[0] = max(limits.v_min, -given[8])
        low, high = [], []
        for axis, rate in enumerate([limits.a_max, limits.alpha_max, limits.a_max][: self.axes]):
            now = given[3 + axis]
            low.append(np.minimum(lows[axis], now + rate * ahead))
            high.append(np.maximum(highs[axis], now - rate * ahead))
        return np.concatenate(low), np.concatenate(high)


def _residuals(casadi: Any, spec: MpcSpec, plan: Any, given: Any, dt: float) -> Any:
    """Return all residuals of a plan, weighted."""
    x, y, yaw, aim_x, aim_y, top = (given[k] for k in (0, 1, 2, 6, 7, 8))
    away = casadi.sqrt((aim_x - x) ** 2 + (aim_y - y) ** 2) + _EPS
    ux, uy = (aim_x - x) / away, (aim_y - y) / away
    bearing = casadi.atan2(uy, ux)
    rows, before, slot = [], 0.0, STATE
    px, py, along = x, y, 0.0
    last = [given[3], given[4], given[5]]
    for k in range(spec.stages):
        now = [plan[k, a] for a in range(plan.shape[1])]
        px, py, yaw = _moved(casadi, (px, py, yaw), now, dt)
        reachable = casadi.fmin(top * dt * (k + 1), away)
        on, off = (px - x) * ux + (py - y) * uy, (py - y) * ux - (px - x) * uy
        rows.append(np.sqrt(spec.progress) / dt * ((reachable - before) - (on - along)))
        rows.append(np.sqrt(spec.contour) * off)
        rows.append(np.sqrt(spec.heading) * casadi.sin(0.5 * (yaw - bearing)))
        rows += [np.sqrt(spec.smoothness) * (a - b) for a, b in zip(now, last, strict=False)]
        before, along, last = reachable, on, now
        for n in range(spec.neighbours + spec.planes):
            row = [given[slot + c] for c in range(COLUMNS)]
            slot += COLUMNS
            lack = _lack(casadi, (px, py, yaw), row, person=n < spec.neighbours)
            weight = spec.closeness if n < spec.neighbours else spec.walls
            rows.append(np.sqrt(weight) * casadi.fmax(0.0, lack))
    return casadi.vertcat(*rows)


def _moved(casadi: Any, pose: tuple[Any, Any, Any], velocity: list[Any], dt: float) -> Any:
    """Return the pose after one stage at a velocity."""
    x, y, yaw = pose
    v, w, *aside = velocity
    middle = yaw + 0.5 * dt * w
    c, s = casadi.cos(middle), casadi.sin(middle)
    vy = aside[0] if aside else 0.0
    return x + dt * (v * c - vy * s), y + dt * (v * s + vy * c), yaw + dt * w


def _lack(casadi: Any, pose: tuple[Any, Any, Any], row: list[Any], *, person: bool) -> Any:
    """Return how much of the wanted clearance to a person or half-plane is lacking, m."""
    c, s = casadi.cos(pose[2]), casadi.sin(pose[2])
    x = pose[0] + c * row[2] - s * row[3]
    y = pose[1] + s * row[2] + c * row[3]
    if person:
        return row[4] - casadi.sqrt((x - row[0]) ** 2 + (y - row[1]) ** 2 + _EPS)
    return row[4] - (row[0] * x + row[1] * y)
