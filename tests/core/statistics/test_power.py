"""The runs that tell a difference: by hand, in conditions, and by trying it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.clusters import Clusters
from crowdbot.core.statistics.power import Power, power
from crowdbot.core.statistics.sign_flip import p_value
from crowdbot.core.statistics.table import Table
from tests.core.statistics.made_up_results import pairs, run, score

NAME = ("m", "corrected")
RNG = np.random.default_rng(77)


def of(results: Results, level: float = 0.95) -> Power:
    found = power(Table(results), NAME, "a", "b", sizes=(0.05, 0.02), level=level)
    assert found is not None
    return found


def conditioned(spreads: dict[str, float], draws: int = 6) -> Results:
    runs, scores = [], []
    for condition, spread in spreads.items():
        noise = RNG.normal(size=draws)
        noise = (noise - noise.mean()) / noise.std(ddof=1) * spread
        for i in range(draws):
            for planner in "ab":
                axes = {"flow": condition, "draw": f"n{i}"}
                name = f"{condition}-{i}"
                runs.append(run(planner, name, name, axes=axes, sim_time=60.0))
                scores.append(score(runs[-1], 0.1 + noise[i] if planner == "a" else 0.0))
    return Results(runs=tuple(runs), scores=tuple(scores))


def test_the_number_of_draws_is_that_of_a_t_test() -> None:
    a = RNG.normal(size=40)
    a = 0.1 * (a - a.mean()) / a.std(ddof=1)
    found = of(pairs(a.tolist(), [0.0] * 40)).whole
    assert found.deviation == pytest.approx(0.1)
    n = found.needed[0.05]
    assert n is not None
    free = n - 1
    reach = stats.t.ppf(0.975, free) + stats.t.ppf(0.8, free)
    assert 0.05 >= 0.1 / n**0.5 * reach > 0.05 * 0.97
    assert (found.needed[0.02] or 0) > 5 * n
    assert found.runs == found.needed  # one run a draw


def test_so_many_draws_find_it_in_four_cases_of_five() -> None:
    a = RNG.normal(size=40)
    a = 0.1 * (a - a.mean()) / a.std(ddof=1)
    n = of(pairs(a.tolist(), [0.0] * 40)).whole.needed[0.05]
    assert n is not None
    groups = Clusters.of([str(i) for i in range(n)])
    found = [p_value(RNG.normal(0.05, 0.1, size=n), groups) <= 0.05 for _ in range(150)]
    assert 0.7 < np.mean(found) < 0.9


def test_conditions_differ_in_what_they_tell() -> None:
    found = of(conditioned({"in": 0.01, "counter": 0.2}))
    quiet, loud = sorted(found.conditions, key=lambda c: c.deviation or 0.0)
    assert quiet.condition.endswith("flow=in")
    assert (quiet.deviation, loud.deviation) == pytest.approx((0.01, 0.2))
    assert (quiet.information, loud.information) == pytest.approx((1 / 0.0002, 1 / 0.08))
    assert loud.share == pytest.approx(0.2**2 / (0.2**2 + 0.01**2))
    assert found.whole.draws == 12
    assert found.whole.minutes == pytest.approx(2.0)
    assert quiet.p < 0.05 < loud.p


def test_each_label_of_an_axis_has_its_own_verdict() -> None:
    runs, scores = [], []
    for flow, gain in {"in": 0.0, "counter": 0.3}.items():
        for i, noise in enumerate((-0.1, 0.1, -0.05, 0.05, -0.15, 0.15)):
            for planner in "ab":
                axes = {"flow": flow, "density": f"d{i % 2}", "draw": f"n{i // 2}"}
                runs.append(run(planner, f"{flow}-{i}", f"{flow}-{i}", axes=axes, sim_time=60.0))
                scores.append(score(runs[-1], gain + noise if planner == "a" else 0.0))
    results = Results(runs=tuple(runs), scores=tuple(scores))
    assert {c.pairs for c in of(results).conditions} == {3}
    found = power(Table(results), NAME, "a", "b", axis="flow")
    assert found is not None
    by_flow = {c.condition: c for c in found.conditions}
    assert {c.pairs for c in by_flow.values()} == {6}
    assert by_flow["in"].p > 0.5
    assert by_flow["counter"].p == pytest.approx(2 / 2**6)
    assert by_flow["counter"].difference.value == pytest.approx(0.3)
    assert sum(c.share or 0.0 for c in by_flow.values()) == pytest.approx(1.0)
    other = power(Table(results), NAME, "a", "b", axis="people")
    assert other is not None
    assert other.conditions == ()  # one group is the whole


def test_stricter_tests_need_more_and_no_spread_needs_the_least() -> None:
    results = conditioned({"in": 0.1, "counter": 0.1})
    one, many = of(results).whole.needed[0.05], of(results, level=0.99).whole.needed[0.05]
    assert one is not None
    assert many is not None
    assert many > one
    none = of(pairs([0.5] * 8, [0.4] * 8)).whole
    assert (none.deviation, none.needed[0.02]) == (0.0, 6)
    assert of(pairs([0.5], [0.4])).whole.needed[0.02] is None


def test_planners_without_common_values() -> None:
    results = pairs([0.5] * 4, [0.4] * 4)
    kept = tuple(s for s in results.scores if not s.run_id.startswith("b"))
    table = Table(replace(results, scores=kept))
    assert power(table, NAME, "a", "b") is None
