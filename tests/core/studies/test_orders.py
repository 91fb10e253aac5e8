"""Orders: each condition as often in each place, and after each other one."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.studies.orders import (
    balance,
    condition_order,
    latin_square,
    trial_order,
    williams,
    write_order_files,
)
from tests.core.studies.study_cases import STUDY, study_of


@pytest.mark.parametrize("n", range(1, 9))
def test_squares_are_balanced(n: int) -> None:
    """Places in both; what comes before only in Williams' design, with n or 2 n rows."""
    as_text = [[str(k) for k in row] for row in williams(n)]
    assert len(as_text) == (n if n % 2 == 0 else 2 * n)
    assert all(sorted(row) == sorted(as_text[0]) for row in as_text)
    assert balance(as_text) == (0, 0)
    latin = [[str(k) for k in row] for row in latin_square(n)]
    assert balance(latin)[0] == 0
    if n > 2:
        assert balance(latin)[1] > 0


def test_the_design_of_four_is_the_published_one() -> None:
    assert williams(4)[0] == [0, 1, 3, 2]


def test_participants_take_turns(tmp_path: Path) -> None:
    study = study_of(tmp_path)
    orders = [condition_order(study, p) for p in study.spec.people]
    assert orders == [["alone", "blended"], ["blended", "alone"]] * 2
    fixed = study_of(tmp_path, STUDY.replace("id: help", "id: help\n  order: fixed"))
    assert condition_order(fixed, "p02") == ["alone", "blended"]


def test_drawn_trials_are_drawn_once_and_for_all(tmp_path: Path) -> None:
    more = "".join(f"    - {{suite: tiny.yaml, scenario: tiny-{k}}}\n" for k in range(5))
    text = STUDY.replace("  consent", f"{more}  trial_order: drawn\n  consent")
    study = study_of(tmp_path, text)
    orders = {p: [k for k, _ in trial_order(study, p, "alone")] for p in study.spec.people}
    assert orders == {p: [k for k, _ in trial_order(study, p, "alone")] for p in study.spec.people}
    assert all(sorted(order) == [1, 2, 3, 4, 5, 6] for order in orders.values())
    assert len({tuple(order) for order in orders.values()}) > 1


def test_order_files_are_one_for_each_participant(tmp_path: Path) -> None:
    files = write_order_files(study_of(tmp_path), tmp_path / "orders")
    assert [f.name for f in files] == [f"FileOrderp0{k}.csv" for k in range(1, 5)]
    assert files[1].read_text() == "blended/tiny.yaml/tiny\nalone/tiny.yaml/tiny\n"
