"""The compiled cost functions against the plain formulas, and where they must not break."""

from __future__ import annotations

import cmath
import importlib
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba import njit

from crowdbot.core.crowd.velocity_search import cost as c
from crowdbot.core.crowd.velocity_search.cost import CompiledCost
from crowdbot.core.crowd.velocity_search.cost_calls import (
    address_of,
    call_base,
    call_excess,
    call_gradient,
    call_optimum,
    call_prepare,
)
from crowdbot.core.crowd.velocity_search.records import AGENT, NEIGHBOUR, WALL, WORK_COLUMNS
from crowdbot.core.support.records import RecordType, rows_of
from crowdbot.core.types.arrays import Array
from crowdbot.plugin import CostFunctionSpec, Range
from tests.built_in import built_in
from tests.examples import costly
from tests.plugins.crowd import cost_formulas as formulas
from tests.plugins.crowd.cost_formulas import Other, Scene

OWN = {"ttca_dca", "rvo"}  # tested with the engine
SPECS = {m.spec.model_fields["kind"].default: m.spec for m in built_in("cost function")}
KINDS = sorted(set(SPECS) - OWN)
FORMULAS = [k for k in KINDS if k != "random_function"]


@njit(cache=True)
def _evaluate(
    at: Array,
    scene: Any,
    counts: Array,
    params: Array,
    work: Array,
    u: Array,
    budget: float,
) -> tuple[float, int]:
    """Base plus excess of one candidate, and what ``prepare`` returned."""
    agent, near, walls = scene
    a, p, w = agent[0], params, work
    items = call_prepare(at[1], a, near, counts[0], walls, counts[1], p, w)
    s = a.preferred
    px, py = (a.pvx / s, a.pvy / s) if s > 0.0 else (1.0, 0.0)
    cost = 0.0 if s == 0.0 else call_base(
        at[0], u[0] * px + u[1] * py, u[1] * px - u[0] * py, s, a.max_speed, p
    )  # fmt: skip
    if items > 0 and cost <= budget:
        cost += call_excess(at[2], u[0], u[1], budget - cost, a, w, p)
    return cost, items


@njit(cache=True)
def _solve(
    at: int,
    best: bool,
    scene: Any,
    params: Array,
    work: Array,
    u: Array,
    out: Array,
) -> int:
    """Gradient or optimum, after `_evaluate`."""
    a, p, w, o = scene[0][0], params, work, out
    if best:
        return int(call_optimum(at, a, w, p, o))
    return int(call_gradient(at, u[0], u[1], a, w, p, o))


def compiled(spec: CostFunctionSpec) -> CompiledCost:
    (found,) = (c for c in built_in("cost function") if c.spec is type(spec))
    module, name = found.build.split(":")
    build = getattr(importlib.import_module(module), name)
    return build(spec)  # type: ignore[no-any-return]


class Probe:
    """One compiled cost function in one scene."""

    def __init__(self, spec: CostFunctionSpec, s: Scene, seed: int = 1) -> None:
        self.cost = compiled(spec)
        base, prepare, excess = self.cost.base, self.cost.prepare, self.cost.excess
        self.at = np.array(
            [address_of(base, c.BASE), address_of(prepare, c.PREPARE), address_of(excess, c.EXCESS)]
        )
        self.scene = (_agent(s, seed), _near(s), _walls(s))
        self.counts = np.array([len(s.others), len(s.walls)])
        rows = c.work_rows(len(s.others) + len(s.walls))
        self.work = np.full((rows + 1, WORK_COLUMNS), np.nan)  # nothing may rely on zeros

    def __call__(self, u: complex, budget: float = math.inf) -> float:
        value, self.items = _evaluate(
            self.at, self.scene, self.counts, self.cost.params, self.work,
            np.array([u.real, u.imag]), budget,
        )  # fmt: skip
        assert np.isnan(self.work[-1]).all()  # wrote past its rows
        return float(value)

    def _solve(self, address: int, best: bool, u: complex) -> complex:
        self(u)
        out = np.full(2, np.nan)
        found = _solve(
            address, best, self.scene, self.cost.params, self.work, np.array([u.real, u.imag]), out
        )
        assert found == 1
        return complex(*out)

    def gradient(self, u: complex) -> complex:
        return self._solve(address_of(self.cost.gradient, c.GRADIENT), False, u)

    def optimum(self) -> complex:
        return self._solve(address_of(self.cost.optimum, c.OPTIMUM), True, 0j)


def _agent(s: Scene, seed: int) -> Any:
    agent, fastest = _unknown(1, AGENT), max(s.s_max, abs(s.v), 4.0)
    given = {
        "px": s.p.real, "py": s.p.imag, "vx": s.v.real, "vy": s.v.imag, "radius": s.r,
        "preferred": s.s, "fastest": fastest, "time_step": s.dt,
        "asked_x": 0.0, "asked_y": 0.0, "asked_radius": fastest,
        "gx": s.goal.real, "gy": s.goal.imag, "pvx": s.v_pref.real, "pvy": s.v_pref.imag,
        "max_speed": s.s_max, "max_acceleration": 5.0, "relaxation": s.tau, "weight": s.mass,
        "parity": float(s.parity), "random": float(seed),
    }  # fmt: skip
    for name, value in given.items():
        agent[name] = value
    return agent


def _unknown(count: int, record: RecordType[Any]) -> Any:
    """Records of NaN, at least one."""
    rows: Any = rows_of(max(1, count), record)
    for name in record.names:
        rows[name] = np.nan
    return rows


def _near(s: Scene) -> Any:
    near = _unknown(len(s.others), NEIGHBOUR)
    for j, o in enumerate(s.others):
        d = o.p - s.p
        near[j] = (
            d.real**2 + d.imag**2, d.real, d.imag, o.v.real, o.v.imag, s.r + o.r,
            o.v_pref.real, o.v_pref.imag, float(o.fixed),
        )  # fmt: skip
    return near


def _walls(s: Scene) -> Any:
    walls = _unknown(len(s.walls), WALL)
    for k, (a, b) in enumerate(s.walls):
        n = formulas.nearest(s.p, a, b) - s.p
        a, b = a - s.p, b - s.p
        walls[k] = (a.real, a.imag, b.real, b.imag, n.real, n.imag, n.real**2 + n.imag**2)
    return walls


def spec_of(kind: str, **fields: Any) -> Any:
    return SPECS[kind](**{"range": Range(value=100.0), **fields})


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_subnormal=False)


def points(size: float) -> st.SearchStrategy[complex]:
    """Multiples of 1e-4: what is parallel or on a border is so exactly, or clearly not."""
    whole = st.integers(-round(size * 1e4), round(size * 1e4))
    return st.builds(lambda x, y: complex(x / 1e4, y / 1e4), whole, whole)


OTHERS = st.builds(
    Other,
    p=points(4.0),
    v=points(1.5),
    r=numbers(0.2, 0.5),
    v_pref=points(1.5),
    fixed=st.just(False),
)
PILLARS = st.builds(Other, p=points(4.0), v=st.just(0j), r=numbers(0.1, 0.5), fixed=st.just(True))
SCENES = st.builds(
    Scene,
    p=points(1.0), v=points(1.5), r=numbers(0.2, 0.4), s=numbers(0.3, 2.0),
    s_max=numbers(1.0, 3.0), goal=points(1.0).map(lambda z: z + 8.0), tau=numbers(0.0, 1.0),
    others=st.lists(OTHERS, max_size=5),
)  # fmt: skip
FULL = st.builds(
    lambda s, more, walls: replace(s, others=s.others + more, walls=walls),
    SCENES,
    st.lists(PILLARS, max_size=2),
    st.lists(
        st.tuples(points(4.0), points(4.0)).filter(lambda w: abs(w[0] - w[1]) > 0.1), max_size=3
    ),
)
QUICK = costly(150)


def same(a: float, b: float) -> bool:
    return a == b or math.isclose(a, b, rel_tol=1e-7, abs_tol=1e-7)


@pytest.mark.parametrize("kind", FORMULAS)
def test_formula(kind: str) -> None:
    """Base plus excess is the formula, walls and pillars included."""

    @QUICK
    @given(FULL, points(2.0), st.booleans(), numbers(2.0, 9.0), st.booleans())
    def check(s: Scene, u: complex, parity: bool, reach: float, surface: bool) -> None:
        seen = Range(value=reach, measure="surface" if surface else "centre")
        spec = spec_of(kind, range=seen)
        s = replace(s, parity=parity, others=[o for o in s.others if not (o.fixed and parity)])
        ours, theirs = Probe(spec, s)(u), formulas.cost(spec, s, u)
        if kind == "paris" and parity:  # shifted, and with the original's rounding
            ours = round(ours - 1e-3, 3)
            theirs = round(theirs, 3) if abs(ours - theirs) > 1e-3 else ours
        # Exactly on a threshold rounding decides: a neighbourhood of the candidate does, too.
        around = [formulas.cost(spec, s, u + 1e-7 * cmath.exp(1j * k)) for k in range(6)]
        assert not math.isnan(ours)
        assert same(ours, theirs) or any(same(ours, x) for x in around) or max(around) > 1e7

    check()


@pytest.mark.slow
@pytest.mark.parametrize("kind", FORMULAS)
def test_budget(kind: str) -> None:
    """Stopping early never makes a candidate look affordable, nor changes one that is."""

    @QUICK
    @given(FULL, points(2.0), numbers(0.0, 20.0))
    def check(s: Scene, u: complex, budget: float) -> None:
        probe = Probe(spec_of(kind), s)
        exact, stopped = probe(u), probe(u, budget)
        assert stopped == exact if exact <= budget else stopped > budget

    check()


def odd_scenes() -> list[Scene]:
    """Everything at once that is zero, coincident, touching or exactly aligned."""
    at = [0j, 0.3 + 0j, 0.6 + 0j, 3 + 0j, 3j, -3 + 0j]
    speeds = [0j, 1.3 + 0j, -1.3 + 0j]
    scenes = []
    for p in at:
        for v_j in speeds:
            for v in speeds:
                other = Other(p=p, v=v_j, r=0.3, v_pref=v_j)
                wall = (p - 1j, p + 1j)
                pillar = Other(p=p, v=0j, r=0.3, fixed=True)
                scenes += [
                    Scene(v=v, others=[other, other]),
                    Scene(v=v, others=[other, pillar], walls=[wall, (p, p), wall]),
                    Scene(v=v, others=[other], tau=0.0, s=0.0),
                    Scene(v=v, others=[other], tau=0.0, goal=0j),
                    Scene(v=v, others=[other], parity=True, walls=[wall]),
                ]
    return scenes


@pytest.mark.parametrize("kind", KINDS)
def test_never_nan(kind: str) -> None:
    for s in odd_scenes():
        probe = Probe(spec_of(kind), s)
        for u in (0j, s.v, 1.3 + 0j, -1.3 + 0j, 0.1j, 1e-300 + 0j, 3 + 0j):
            if s.v_pref != 0:  # where it is zero nobody looks for a velocity
                first = probe(u)
                assert not math.isnan(first), (s, u)
                assert first == probe(u) or kind == "random_function"
            if probe.cost.gradient is not None:
                assert cmath.isfinite(probe.gradient(u)), (s, u)
        if probe.cost.optimum is not None:
            assert cmath.isfinite(probe.optimum()), s


@pytest.mark.parametrize("kind", sorted(formulas.FORCES))
def test_force(kind: str) -> None:
    """The gradient at the present velocity is minus the force; the optimum is its effect."""

    @QUICK
    @given(FULL)
    def check(s: Scene) -> None:
        spec = spec_of(kind)
        force = formulas.FORCES[kind](spec, s)
        probe = Probe(spec, s)
        assert abs(probe.gradient(s.v) + force) <= 1e-6 * max(1.0, abs(force))
        assert abs(probe.optimum() - s.v - force * s.dt) <= 1e-6 * max(1.0, abs(force))

    check()


@QUICK
@given(FULL, points(2.0), st.booleans())
def test_foe_gradient(s: Scene, u: complex, parity: bool) -> None:
    spec = spec_of("foe_avoidance")
    s = replace(s, parity=parity, others=[o for o in s.others if not (o.fixed and parity)])
    theirs = [
        formulas.foe_gradient(spec, s, u + 1e-9 * cmath.exp(1j * k)) for k in range(6)
    ]  # fmt: skip
    theirs.append(formulas.foe_gradient(spec, s, u))
    ours = Probe(spec, s).gradient(u)
    assert min(abs(ours - x) for x in theirs) <= 1e-5 * max(1.0, abs(ours))


@pytest.mark.slow
@QUICK
@given(FULL, st.integers(0, 2**32))
def test_orca_optimum(s: Scene, seed: int) -> None:
    """No velocity costs less than the optimum, be the half-planes compatible or not."""
    spec = spec_of("orca")
    best = Probe(spec, s).optimum()
    assert abs(best) <= s.s_max * (1.0 + 1e-9)
    planes = formulas.orca_planes(spec, s)

    def worst(u: complex) -> float:
        return max(0.0, *[formulas.dot(p - u, n) for p, n in planes], 0.0)

    rng = np.random.default_rng(seed)
    angle, size = rng.uniform(0.0, 2.0 * math.pi, 300), s.s_max * np.sqrt(rng.random(300))
    near = best + 10.0 ** rng.uniform(-4.0, 0.0, 300) * np.exp(1j * angle)
    others = [u for u in [*(size * np.exp(1j * angle)), *near] if abs(u) <= s.s_max]
    if worst(best) <= 1e-7:
        assert all(
            abs(u - s.v_pref) >= abs(best - s.v_pref) - 1e-6 for u in others if worst(u) == 0.0
        )
    else:
        assert all(worst(u) >= worst(best) - 1e-6 for u in others)


def test_random_function_draws_from_the_agents_generator() -> None:
    """Park and Miller's numbers; y before x in the gradient."""
    state = [1]
    for _ in range(4):
        state.append(16807 * state[-1] % 2147483647)
    expected = [2.0 * (x - 1) / 2**31 - 1.0 for x in state[1:]]
    probe = Probe(spec_of("random_function"), Scene(), seed=1)
    assert probe.cost.ordered
    draws = [probe(0j) - 1.0, probe(1 + 0j) - 1.0]
    assert draws == pytest.approx(expected[:2], abs=1e-6)
    probe = Probe(spec_of("random_function"), Scene(), seed=state[1])
    gradient = probe.gradient(0j)  # evaluates once before
    assert (gradient.imag, gradient.real) == pytest.approx(tuple(expected[2:4]), abs=1e-6)


@pytest.mark.parametrize("kind", sorted(set(FORMULAS) - {"goal_reaching_force"}))
@pytest.mark.parametrize("what", ["person", "pillar", "wall"])
def test_obstacles_matter(kind: str, what: str) -> None:
    """Walking on into somebody, a pillar or a wall costs more than in the open."""
    spec, u = spec_of(kind), 1.3 + 0j
    wall = (0.9 - 2j, 0.9 + 2.1j)
    ahead = Other(p=0.9 + 0.05j, v=0j, r=0.3, fixed=what == "pillar")
    alone = Scene(v=u)
    blocked = replace(alone, walls=[wall]) if what == "wall" else replace(alone, others=[ahead])
    assert Probe(spec, blocked)(u) > Probe(spec, alone)(u) + 1e-6
