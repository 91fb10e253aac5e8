r"""Are verdicts right where the truth is known, with few draws and skewed scores?

Makes up campaigns of two planners with scores like those of an edition, draw by draw, and counts
how often the first is certified better and worse at 5 %, and how often the interval of 95 % of the
mean difference covers the truth:

    python benchmarks/planted_verdicts.py --seed 36036 --campaigns 1000

`planted` rows are traps: one planner is faster but worth nothing in a tenth of its runs with an
equal mean, or in 12 % with a mean that is lower by 0.02. `null` rows are exchangeable. Draws are
alone, or in eight conditions of 18 as in `challenge-2026`.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.sign_flip import p_value

Floats = NDArray[np.float64]
Draw = Callable[[np.random.Generator, int], Floats]
#: Conditions and draws in each; one condition: draws alone.
SIZES = ((1, 8), (1, 12), (1, 18), (8, 8), (8, 12), (8, 18))


def planted(zeros: float, less: float) -> Draw:
    """Scores of 0.7 that are faster than the other's, and 0 in a share of runs."""

    def draw(rng: np.random.Generator, n: int) -> Floats:
        value = rng.normal(0.7, 0.06, size=n)
        own = np.where(rng.random(n) < zeros, 0.0, value)
        return np.asarray(own - value * (1.0 - zeros) - less + 0.04 * rng.normal(size=n))

    return draw


def zeros_of_both(share: float) -> Draw:
    """Two planners alike: arrived, or 0 in a share of runs, each on its own."""

    def draw(rng: np.random.Generator, n: int) -> Floats:
        value = rng.normal(0.7, 0.06, size=n)
        own, other = np.where(rng.random((2, n)) < share, 0.0, value + rng.normal(0, 0.04, (2, n)))
        return np.asarray(own - other)

    return draw


def lognormal(rng: np.random.Generator, n: int) -> Floats:
    """Differences of two planners with the same skewed scores."""
    own, other = np.exp(rng.normal(0.0, 1.0, size=(2, n)))
    return np.asarray(own - other)


def one_sided(rng: np.random.Generator, n: int) -> Floats:
    """Equal means, of which only one planner's scores are skewed (not exchangeable)."""
    return np.asarray(np.exp(rng.normal(0.0, 1.0, size=n)) - np.exp(0.5) + rng.normal(size=n))


#: What is drawn -> how, and its true mean.
ROWS: Mapping[str, tuple[Draw, float]] = {
    "planted: equal mean, 10 % zeros": (planted(0.10, 0.0), 0.0),
    "planted: mean -0.02, 12 % zeros": (planted(0.12, 0.02), -0.02),
    "null: normal": (lambda rng, n: rng.normal(size=n), 0.0),
    "null: heavy tails": (lambda rng, n: rng.normal(size=n) * rng.exponential(size=n), 0.0),
    "null: lognormal of both": (lognormal, 0.0),
    "null: 10 % zeros of both": (zeros_of_both(0.10), 0.0),
    "null: 40 % zeros of both": (zeros_of_both(0.40), 0.0),
    "equal means: lognormal of one": (one_sided, 0.0),
}


def shares(draw: Draw, truth: float, groups: Clusters, seed: list[int], count: int) -> Floats:
    """Return the shares of better, worse and covered among campaigns."""
    rng, found = np.random.default_rng(seed), np.zeros(3)
    for _ in range(count):
        gains = draw(rng, groups.count)
        told = p_value(gains, groups) <= 0.05
        x = c.mean(gains, groups)
        found[0] += told and gains.mean() > 0.0
        found[1] += told and gains.mean() < 0.0
        found[2] += x.low is not None and x.high is not None and x.low <= truth <= x.high
    return found / count


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--campaigns", type=int, default=200)
    parser.add_argument("--only", default="*", metavar="GLOB", help="of the rows' names")
    parser.add_argument("--edition", action="store_true", help="only eight conditions of 18 draws")
    given = parser.parse_args()
    print(f"{'':34}{'draws':>9}{'better':>9}{'worse':>9}{'covered':>9}")
    for i, (name, (draw, truth)) in enumerate(ROWS.items()):
        if not fnmatchcase(name, given.only):
            continue
        for conditions, draws in SIZES[-1:] if given.edition else SIZES:
            n = conditions * draws
            strata = [str(k // draws) for k in range(n)]
            groups = Clusters.of([str(k) for k in range(n)], strata)
            found = shares(draw, truth, groups, [given.seed, i, n], given.campaigns)
            size = f"{conditions} x {draws}" if conditions > 1 else str(draws)
            print(f"{name:34}{size:>9}" + "".join(f"{s:9.1%}" for s in found), flush=True)


if __name__ == "__main__":
    main()
