"""What a worker keeps of a planner from one run to the next."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.campaign import execute
from crowdbot.core.campaign.job import SuiteSource
from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.errors import PlannerError
from tests.core.planning.process.process_cases import planner_text

pytestmark = pytest.mark.slow
SOURCE = SuiteSource(spec="challenge-2020", allowed=())
#: Dies by a signal while it is loaded, as long as there is a file beside it.
DYING = """
from pathlib import Path
if Path(__file__).with_name("deadly").exists():
    os.kill(os.getpid(), signal.{signal})
"""


def chosen(file: Path) -> PlannerChoice:
    """As a campaign's worker does it for each run."""
    return execute._choice(f"{file}:Mine", (), SOURCE, PlannerPlace(lenient=True))


@pytest.mark.parametrize("signal", ["SIGKILL", "SIGSEGV"])
def test_a_planner_that_died_is_loaded_again_for_the_next_run(tmp_path: Path, signal: str) -> None:
    file = tmp_path / "mine.py"
    file.write_text(planner_text(top=DYING.format(signal=signal)), encoding="utf-8")
    (tmp_path / "deadly").touch()
    for _ in range(2):  # the runs whose planner was killed
        killed = chosen(file)
        assert signal in killed.died
        with pytest.raises(PlannerError, match=f"did not load: .*{signal}"):
            killed.build()
    (tmp_path / "deadly").unlink()
    alive = chosen(file)
    assert (alive.died, alive.spec_dump) == ("", killed.spec_dump)
    alive.build().close()  # type: ignore[attr-defined]
    assert chosen(file) is alive


def test_one_that_raises_is_not_loaded_again(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(planner_text(top="raise RuntimeError('no')"), encoding="utf-8")
    assert chosen(file).died == ""
    assert chosen(file) is chosen(file)
