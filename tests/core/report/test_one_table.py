"""Gathering a report lays the results out once, whatever is worked out of them."""

from __future__ import annotations

import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.table import Table
from tests.core.report.report_cases import contents
from tests.core.statistics.test_floors import results


def test_one_table(monkeypatch: pytest.MonkeyPatch) -> None:
    made = []
    lay_out = Table.__init__

    def counted(self: Table, results: Results) -> None:
        made.append(results)
        lay_out(self, results)

    monkeypatch.setattr(Table, "__init__", counted)
    contents(results({"mine": [1.0, 0.0], "other": [0.5, 0.5], "blind": [0.0, 0.0]}))
    assert len(made) == 1
