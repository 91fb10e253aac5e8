"""Calibration: parameters, bounds, and fits that are repeatable and go on from their log."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.realism import calibrate
from crowdbot.core.realism.calibrate import FitTask, Generation, fit
from crowdbot.core.realism.parameters import numbers, overrides_of, parameters_of, shares_of
from crowdbot.core.realism.reference import shipped
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.named_crowds import open_crowd
from crowdbot.errors import InputError, UnknownNameError

REGISTRY = discover(allow=())
CROWD = open_crowd("power_law", REGISTRY)


def test_all_positive_numbers_or_the_chosen_ones() -> None:
    every = {p.key for p in parameters_of(CROWD)}
    assert {"crowd.costs.avoid.k", "crowd.costs.avoid.tau0", "crowd.speed.mean"} <= every
    assert not any("range" in key or "mass" in key for key in every)
    (one,) = parameters_of(CROWD, ["costs.avoid.k=0.5..8"])
    assert (one.low, one.high) == (0.5, 8.0)
    assert one.value(0.5) == pytest.approx(2.0)  # by ratio
    assert one.value(one.share(3.0)) == pytest.approx(3.0)
    (text,) = overrides_of([one], shares_of([one]))
    assert text.startswith("crowd.costs.avoid.k=")
    assert float(text.partition("=")[2]) == pytest.approx(one.start)
    assert dict(numbers(CROWD))["crowd.costs.avoid.k"] == one.start


@pytest.mark.parametrize("text", ["costs.avoid.k=3", "costs.avoid.k=4..2", "costs.avoid.k=a..b"])
def test_bounds_that_make_no_sense(text: str) -> None:
    with pytest.raises(InputError, match=r"LOW\.\.HIGH"):
        parameters_of(CROWD, [text])


def test_a_number_that_is_not_there() -> None:
    with pytest.raises(UnknownNameError, match=r"did you mean 'crowd\.costs\.avoid\.k'"):
        parameters_of(CROWD, ["costs.avoid.kk"])


class Counted:
    """A loss with its least at k = 3 and tau0 = 2 that counts how often it is asked."""

    def __init__(self) -> None:
        self.asked = 0

    def __call__(self, task: FitTask, overrides: Sequence[str], seed: int) -> float:
        del task, seed
        self.asked += 1
        k, tau = (float(text.partition("=")[2]) for text in overrides)
        return (k - 3.0) ** 2 + (tau - 2.0) ** 2


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Counted:
    found = Counted()
    monkeypatch.setattr(calibrate, "loss", found)
    monkeypatch.setattr(calibrate, "_walk", lambda *_: shipped().floors["avoid nobody"])
    return found


def run(log: Path, generations: int, watch: Any = lambda _generation: None) -> Any:
    parameters = parameters_of(CROWD, ["costs.avoid.k=0.5..8", "costs.avoid.tau0=0.5..6"])
    return fit(FitTask(crowd="power_law"), parameters, log, generations=generations, watch=watch)


def test_a_fit_finds_the_least_loss_and_tells_its_spread(counted: Counted, tmp_path: Path) -> None:
    found = run(tmp_path / "a.jsonl", 30)
    assert found.values["crowd.costs.avoid.k"] == pytest.approx(3.0, abs=0.2)
    assert found.values["crowd.costs.avoid.tau0"] == pytest.approx(2.0, abs=0.2)
    assert 0.0 < found.spread["crowd.costs.avoid.k"] < 0.5
    assert found.evaluations == counted.asked
    assert found.ceiling == pytest.approx(shipped().ceiling.score)


def test_a_fit_that_was_stopped_goes_on(counted: Counted, tmp_path: Path) -> None:
    whole = run(tmp_path / "whole.jsonl", 6)
    asked = counted.asked
    run(tmp_path / "half.jsonl", 3)
    text = (tmp_path / "half.jsonl").read_text()
    (tmp_path / "half.jsonl").write_text(text + '{"losses": [0.1, 0.')  # cut off
    steps: list[Generation] = []
    again = run(tmp_path / "half.jsonl", 6, steps.append)
    assert again == whole
    assert [step.from_log for step in steps] == [True] * 3 + [False] * 3
    assert counted.asked == 2 * asked
    assert (tmp_path / "half.jsonl").read_text() == (tmp_path / "whole.jsonl").read_text()


def test_the_log_of_another_fit_is_refused(counted: Counted, tmp_path: Path) -> None:
    del counted
    run(tmp_path / "a.jsonl", 1)
    parameters = parameters_of(CROWD, ["costs.avoid.k"])
    with pytest.raises(InputError, match="log of another calibration"):
        fit(FitTask(crowd="power_law"), parameters, tmp_path / "a.jsonl", generations=2)
