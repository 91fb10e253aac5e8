"""A disk that is full while a job writes ends the campaign, and is nobody's failure."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from crowdbot.core.campaign.execute import failed_job
from crowdbot.core.campaign.job import Job, JobOutcome
from crowdbot.core.campaign.plan import make_plan
from crowdbot.core.campaign.request import CampaignRequest
from crowdbot.core.campaign.run import State, run_campaign
from crowdbot.core.registry.registry import discover
from crowdbot.errors import CrowdbotError, InputError, PlannerError

FULL = errno.ENOSPC
ONE = "in-d0125-slow-c01-r02"


def _raised(error: CrowdbotError, cause: OSError) -> CrowdbotError:
    """The error as it is after ``raise error from cause``."""
    error.__cause__ = cause
    return error


class _Pool:
    """Ends each job with what one of a full disk gives."""

    def __init__(self, number: int) -> None:
        self._number, self._jobs, self.submitted = number, list[Job](), 0

    def free_slots(self) -> int:
        return 1 - len(self._jobs)

    def submit(self, job: Job) -> None:
        self._jobs.append(job)
        self.submitted += 1

    def finished(self, timeout: float) -> list[JobOutcome]:
        del timeout
        error = _raised(InputError("run.mcap: cannot be written"), OSError(self._number, "no"))
        ended = [failed_job(job, error) for job in self._jobs]
        self._jobs.clear()
        return ended

    def busy(self) -> list[object]:
        return []

    def close(self) -> None:
        pass


def _run(out: Path, pool: _Pool) -> State:
    request = CampaignRequest(
        suites=["challenge-2020"], only=["in-d0125-slow-c01-r0*"], planners=["goal_seek"], out=out
    )
    plan = make_plan(request, discover())
    return run_campaign(plan, pool, 1, lambda *_: None)  # type: ignore[arg-type]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_a_full_disk_ends_a_campaign(tmp_path: Path, number: int) -> None:
    pool = _Pool(number)
    with pytest.raises(InputError, match=r"^run\.mcap: .* free some, and the same command goes on"):
        _run(tmp_path, pool)
    assert pool.submitted == 1
    assert not list(tmp_path.rglob("*.failure.json"))


def test_another_fault_of_a_file_does_not(tmp_path: Path) -> None:
    pool = _Pool(errno.EIO)
    assert len(_run(tmp_path, pool).failures) > 1


def test_planners_cannot_end_a_campaign_so(tmp_path: Path) -> None:
    plan = make_plan(
        CampaignRequest(
            suites=["challenge-2020"], planners=["goal_seek"], only=[ONE], out=tmp_path
        ),
        discover(),
    )
    job = plan.jobs[0]
    of_planner = _raised(PlannerError("step raised OSError"), OSError(FULL, "no"))
    assert not failed_job(job, of_planner).disk_full
    assert failed_job(job, OSError(FULL, "no")).disk_full
