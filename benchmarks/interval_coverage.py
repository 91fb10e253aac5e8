r"""Do the intervals cover, with runs that share crowd draws?

Simulates campaigns of 18 draws with 9 scenarios each: effects of draws, of scenarios and of runs,
in several proportions, symmetric and skewed. Prints how often 95 % intervals cover the truth, and
how often the test finds a difference that is not there (symmetric only: the test asks whether one
planner is better more often, not about means).

    python benchmarks/interval_coverage.py --repetitions 1000
    python benchmarks/interval_coverage.py --conditions --repetitions 2000

``--conditions`` asks instead whether intervals cover the mean over 18 fixed conditions and all
people: conditions differ by up to 170 standard deviations of people. Nested, each condition has
draws of its own, as in `challenge-2026`; crossed, all conditions have the same draws, which answer
differently in each.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.statistics import clusters as c
from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.effect_size import effect_size
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.sign_flip import p_value
from crowdbot.core.statistics.signed_rank import double_ranks, signed_ranks

DRAWS, SCENARIOS, CONDITIONS = 18, 9, 18
#: Means of the conditions, in standard deviations of people.
EFFECTS = 10.0 * np.arange(CONDITIONS)
#: Standard deviations of draw, scenario and run.
SPREADS = ((0.0, 0.0, 1.0), (0.3, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (2.0, 0.5, 0.5))
COLUMNS = ("mean t", "d", "P(better) t", "rank r t")
_LARGE = 2_000_000

Floats = NDArray[np.float64]


def noise(rng: np.random.Generator, size: tuple[int, ...], *, skewed: bool) -> Floats:
    """Mean 0, variance 1."""
    if not skewed:
        return rng.normal(size=size)
    euler = math.e
    return np.asarray((np.exp(rng.normal(size=size)) - euler**0.5) / (euler * (euler - 1)) ** 0.5)


def campaign(
    rng: np.random.Generator, spread: tuple[float, float, float], seeds: int, *, skewed: bool
) -> Floats:
    sizes = ((DRAWS, 1, 1), (DRAWS, SCENARIOS, 1), (DRAWS, SCENARIOS, seeds))
    parts = [s * noise(rng, size, skewed=skewed) for s, size in zip(spread, sizes, strict=True)]
    return np.broadcast_to(sum(parts), sizes[-1]).reshape(-1)


def truths(spread: tuple[float, float, float], *, skewed: bool) -> dict[str, float]:
    rng = np.random.default_rng(1)
    large = sum(s * noise(rng, (_LARGE,), skewed=skewed) for s in spread)
    large = np.asarray(large)
    other = np.asarray(sum(s * noise(rng, (_LARGE,), skewed=skewed) for s in spread))
    return {
        "mean": 0.0,
        "d": 0.0,
        "P": float((large > 0).mean()),
        "rank": 2 * float((rng.permutation(large) + other > 0).mean()) - 1,  # Walsh averages
    }


def intervals(values: Floats, groups: Clusters) -> Iterator[tuple[str, str, Estimate]]:
    yield "mean t", "mean", c.mean(values, groups)
    yield "d", "d", effect_size(values, groups)
    yield "P(better) t", "P", c.mean(0.5 + np.sign(values) / 2, groups)
    ranks = signed_ranks(values, double_ranks(values)).astype(float)
    yield "rank r t", "rank", c.ratio(ranks, np.abs(ranks), groups)


def conditioned(rng: np.random.Generator, draws: int, *, crossed: bool) -> Floats:
    """Scores of 18 conditions with some draws of people each, one after the other."""
    effects = EFFECTS[:, None]
    people = rng.normal(size=(1 if crossed else CONDITIONS, draws))
    own = rng.normal(size=(CONDITIONS, draws))
    return np.asarray(effects + people + 0.5 * own).reshape(-1)


def by_conditions(repetitions: int) -> None:
    """Print how often the interval of a mean covers it."""
    truth = float(EFFECTS.mean())
    print(f"{'draws':9}{'a condition':>12}{'mean t':>9}")
    for crossed, draws in ((False, 2), (False, 5), (False, 9), (True, 9), (True, 18)):
        names = [f"{'' if crossed else k} {i}" for k in range(CONDITIONS) for i in range(draws)]
        strata = [str(k) for k in range(CONDITIONS) for _ in range(draws)]
        groups = Clusters.of(names, strata)
        rng, found = np.random.default_rng(11), 0
        for _ in range(repetitions):
            x = c.mean(conditioned(rng, draws, crossed=crossed), groups)
            assert x.low is not None
            assert x.high is not None
            found += x.low <= truth <= x.high
        kind = "crossed" if crossed else "nested"
        print(f"{kind:9}{draws:12}{found / repetitions:9.1%}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--conditions", action="store_true", help="fixed ones, with many draws")
    parser.add_argument("--repetitions", type=int, default=1000)
    parser.add_argument("--seeds", type=int, default=1)
    options = parser.parse_args()
    if options.conditions:
        by_conditions(options.repetitions)
        return
    groups = Clusters.of(
        [f"draw {i}" for i in range(DRAWS) for _ in range(SCENARIOS * options.seeds)]
    )
    heads = "".join(f"{name:>13}" for name in COLUMNS)
    print(f"{'noise':11}{'draw, scenario, run':21}{heads}{'false':>9}")
    for skewed in (False, True):
        for spread in SPREADS:
            rng = np.random.default_rng(7)
            truth, found, false = truths(spread, skewed=skewed), Counter[str](), 0
            for _ in range(options.repetitions):
                values = campaign(rng, spread, options.seeds, skewed=skewed)
                for column, name, x in intervals(values, groups):
                    assert x.low is not None
                    assert x.high is not None
                    found[column] += x.low <= truth[name] <= x.high
                false += p_value(values, groups) <= 0.05
            shares = "".join(f"{found[n] / options.repetitions:13.1%}" for n in COLUMNS)
            level = "" if skewed else f"{false / options.repetitions:9.1%}"
            kind = "lognormal" if skewed else "normal"
            print(f"{kind:11}{', '.join(f'{s:g}' for s in spread):21}{shares}{level}", flush=True)


if __name__ == "__main__":
    main()
