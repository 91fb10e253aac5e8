"""Hints during a campaign: results that are already known, and when it may be stopped."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crowdbot.core.support.text import listed, plural

if TYPE_CHECKING:
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.campaign.run import State


def known_runs(plan: Plan) -> str:
    """Return a hint on missing runs whose scores are in the shipped references; else ""."""
    from crowdbot.core.campaign.extend_references import known_jobs
    from crowdbot.core.results.reference_file import SHIPPED, shipped_runs

    missing = [job for job in plan.jobs if job.kind == "run"]
    # Reading them takes half a second. A user who left out floors and ceilings knows the hint.
    if not any(job.added for job in missing):
        return ""
    known = known_jobs(plan, shipped_runs())
    if not known:
        return ""
    named = [*dict.fromkeys(job.label for job in known if not job.added)]
    without = f"leave out {listed(named)} and " if named else ""
    return (
        f"{len(known)} of {plural(len(missing), 'run')} are in the reference scores: to save time, "
        f"{without}add --no-floors, then see 'crowdbot results --reference {SHIPPED}'"
    )


class OwnFirst:
    """Tells the user once that only runs of floor and ceiling planners remain."""

    def __init__(self) -> None:
        self._waits = True

    def line(self, state: State) -> str:
        """Return a message, once the user's own planners are done; else an empty text."""
        left = state.left.values()
        if not (self._waits and left and all(job.added for job in left)):
            return ""
        self._waits = False
        if not any(not job.added for job in state.plan.jobs):
            return ""  # a second call that completes the floors
        return (
            f"your planners are done; {plural(len(left), 'job')} of floors and ceilings left. "
            "Ctrl-C keeps what is done"
        )
