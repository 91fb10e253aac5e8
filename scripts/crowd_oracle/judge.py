"""Comparison of steps of our crowd with those of the original, one at a time.

Single precision decides ties and thresholds, and symmetric layouts are full of them. A sample (one
agent in one step) that differs is *reachable* if a perturbed input makes our engine produce it,
if our cost of what the original chose is hardly above our minimum, or if that holds once every
candidate may be off by the rounding of the original, which decides at limits that the same rounding
has put some of them on. Otherwise it is a miss, and so is a sample that ends somewhere else than
the original's: contact, clamping and motion are those of our engine.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from crowdbot.core.crowd.policy import CrowdView
from crowdbot.core.crowd.velocity_search.evaluate import Evaluator
from crowdbot.core.crowd.velocity_search.gradient import Descent
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.types.arrays import Array, Mask
from scripts.crowd_oracle.case import Case
from scripts.crowd_oracle.step import Stepper

#: Velocities closer than this agree, m/s.
CLOSE = 5e-4
#: Error of a position some ten metres away in single precision, m.
_BESIDE = 2e-5
#: Largest perturbation of a position (m) or velocity (m/s); number of perturbations tried.
PERTURBATION, PERTURBATIONS = 1e-5, 256
#: Number of random subsets of people to perturb, and the share of people in each.
SUBSETS, _SHARES = 128, (0.1, 0.25, 0.5)
#: Largest excess of the original's choice over our minimum cost.
RELATIVE, ABSOLUTE = 1e-3, 1e-6
#: Largest difference between the original's candidates and ours: about ten roundings, m/s.
ROUNDING = 1e-6
_SEED = 20201021


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Counts of samples, and residuals |dv| of agreeing samples, m/s.

    Attributes:
        by_rounding: samples decided by a candidate on a limit.
        not_a_number: samples in which the original has NaN; not counted in ``samples``.
        first_misses: step and agent id of up to ten misses.
    """

    name: str
    samples: int
    outright: int
    by_perturbation: int
    by_cost: int
    by_rounding: int
    misses: int
    not_a_number: int
    median: float
    p99: float
    largest: float
    first_misses: list[tuple[int, int]]

    def as_dict(self) -> dict[str, Any]:
        """Return a dictionary for JSON."""
        return asdict(self)


@dataclass(slots=True)
class _Count:
    samples: int = 0
    by_perturbation: int = 0
    by_cost: int = 0
    by_rounding: int = 0
    not_a_number: int = 0


def judge(case: Case) -> Verdict:
    """Replay a case."""
    stepper, count = Stepper(case), _Count()
    agreed: list[Array] = [np.zeros(0)]
    missed: list[tuple[int, int]] = []
    for k in range(len(case.states) - 1):
        residual, left = _judge_step(stepper, k, count)
        agreed.append(residual)
        missed += [(k, int(case.agents.id[i])) for i in np.flatnonzero(left)]
    residuals = np.concatenate(agreed)
    median, p99, largest = (
        np.quantile(residuals, [0.5, 0.99, 1.0]).tolist() if len(residuals) else (0.0, 0.0, 0.0)
    )
    return Verdict(
        name=case.name, samples=count.samples, outright=len(residuals),
        by_perturbation=count.by_perturbation, by_cost=count.by_cost,
        by_rounding=count.by_rounding, misses=len(missed), not_a_number=count.not_a_number,
        median=median, p99=p99, largest=largest, first_misses=missed[:10],
    )  # fmt: skip


def _judge_step(stepper: Stepper, k: int, count: _Count) -> tuple[Array, Mask]:
    """Return residuals of agreeing samples of step k, and a mask of misses."""
    case = stepper.case
    before, after = case.states[k], case.states[k + 1]
    known = case.present[k] & case.present[k + 1]
    there = known & np.isfinite(before).all(axis=1) & np.isfinite(after).all(axis=1)
    count.not_a_number += int(np.count_nonzero(known & ~there))
    count.samples += int(np.count_nonzero(there))
    theirs, random = after, stepper.random()
    ours = stepper.step(before)
    following = stepper.random()
    left = there & ~agrees(case, ours, theirs)
    residual = np.hypot(*(ours - theirs)[:, 2:].T)[there & ~left]
    cheap = left & by_cost_alone(stepper, before, theirs, random, left)
    left &= ~cheap
    found = left & by_perturbed_input(stepper, before, theirs, random, left)
    left &= ~found
    rounded = left & by_cost_alone(stepper, before, theirs, random, left, rounding=ROUNDING)
    count.by_cost += int(np.count_nonzero(cheap))
    count.by_perturbation += int(np.count_nonzero(found))
    count.by_rounding += int(np.count_nonzero(rounded))
    stepper.restore(following)
    return residual, left & ~rounded


def agrees(case: Case, ours: Array, theirs: Array) -> Mask:
    """Return rows of states (N, 4) that are equal up to rounding, including positions.

    At a periodic boundary, one may have crossed it just before the other.
    """
    off = np.abs(ours[:, :2] - theirs[:, :2])
    if case.periodic_boundary is not None:
        x0, x1, y0, y1 = case.periodic_boundary
        for axis, low, high in ((0, x0, x1), (1, y0, y1)):
            place = theirs[:, axis]
            edge = np.minimum(np.abs(place - low), np.abs(place - high)) < 10.0 * CLOSE * case.dt
            across = np.abs(off[:, axis] - (high - low))
            off[:, axis] = np.where(edge, np.minimum(off[:, axis], across), off[:, axis])
    near = np.hypot(off[:, 0], off[:, 1]) < CLOSE * case.dt + _BESIDE
    return np.asarray(near & (np.hypot(*(ours - theirs)[:, 2:].T) < CLOSE))


def by_perturbed_input(
    stepper: Stepper, state: Array, theirs: Array, random: list[Array], who: Mask
) -> Mask:
    """Return samples that our engine reproduces from an input changed by at most `PERTURBATION`.

    First all people are perturbed, then random subsets: a tie decided by one neighbour may be
    undone by another who also moves.
    """
    found, rng = np.zeros(len(state), np.bool_), np.random.default_rng(_SEED)
    for attempt in range(PERTURBATIONS + SUBSETS):
        left = who & ~found
        if not np.any(left):
            break
        size = PERTURBATION * (0.1 if attempt % 4 == 3 else 1.0)
        shaken = rng.uniform(-size, size, state.shape)
        if attempt >= PERTURBATIONS:
            share = _SHARES[attempt % len(_SHARES)]
            shaken[rng.random(len(state)) >= share] = 0.0
        stepper.restore(random)
        ours = stepper.step(state + shaken, left)
        found |= left & agrees(stepper.case, ours, theirs)
    return found


def by_cost_alone(
    stepper: Stepper,
    state: Array,
    theirs: Array,
    random: list[Array],
    who: Mask,
    *,
    rounding: float = 0.0,
) -> Mask:
    """Return samples that equal a candidate whose cost is hardly above our minimum.

    Args:
        rounding: largest error of each candidate, m/s. The original's choice then counts with its
            lowest cost, and the minimum is taken over the candidates' highest costs: a candidate
            that rounding forbids is no longer a competitor, one that rounding allows is a valid
            choice.
    """  # fmt: skip
    found = np.zeros(len(state), np.bool_)
    push = stepper.push(state) if np.any(who) else state[:, 2:]
    for k, policy in enumerate(stepper.policies):
        minimiser, mine = policy.minimiser, who & (stepper.case.agents.policy == k)
        if isinstance(minimiser, Descent) or not np.any(mine):
            continue
        view = stepper.view(state, k, mine)
        stepper.restore(random)
        if isinstance(minimiser, Sampler):
            velocities = minimiser.candidates(view)
        elif minimiser.is_closed:
            best, time = minimiser.choose(view), max(policy.costs.relaxation_time, view.dt)
            chosen = state[:, 2:] + ((theirs - state)[:, 2:] - push) * (time / view.dt)
            velocities = np.stack([best, np.where(np.isfinite(chosen), chosen, 0.0)], axis=1)
        else:
            velocities = minimiser.search.candidates(view)
        cheapest, dearest = _costs(Evaluator(policy.costs), view, velocities, rounding)
        least = np.min(dearest, axis=1, keepdims=True)
        with np.errstate(invalid="ignore"):
            cheap = cheapest <= least + np.maximum(RELATIVE * np.abs(least), ABSOLUTE)
        for s in np.flatnonzero(np.any(cheap[mine], axis=0)):
            reached = stepper.move(state, policy.towards(velocities[:, s], view))
            found |= mine & cheap[:, s] & agrees(stepper.case, reached, theirs)
    return found


def _costs(
    evaluator: Evaluator, view: CrowdView, velocities: Array, rounding: float
) -> tuple[Array, Array]:
    """Return least and largest cost (N, S) of candidates (N, S, 2), moved along and across."""
    cheapest = evaluator.total(view, velocities)
    dearest = cheapest
    if rounding > 0.0:
        speed = np.maximum(np.hypot(velocities[..., 0], velocities[..., 1]), rounding)
        along = velocities * (rounding / speed)[..., np.newaxis]
        across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
        for step in (along, -along, across, -across):
            total = evaluator.total(view, velocities + step)
            cheapest, dearest = np.minimum(cheapest, total), np.maximum(dearest, total)
    return cheapest, dearest
