from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.simulate_cases import Shell


@pytest.fixture
def shell(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Shell:
    return Shell(tmp_path / "runs", capsys)
