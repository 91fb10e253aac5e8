from __future__ import annotations

import pytest

from tests.core.report import report_cases


@pytest.fixture(scope="session", autouse=True)
def _shared_folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Where workers share what `report_cases.full` gathers."""
    report_cases.FACTORY.append(tmp_path_factory)
