"""Progress of a campaign: a live table on a terminal, lines elsewhere."""

from __future__ import annotations

import logging
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from crowdbot.cli.output.campaign_hints import OwnFirst, known_runs
from crowdbot.cli.output.say import say
from crowdbot.core.support.text import plural, rough_time
from crowdbot.core.types.ending import has_failed, shown

if TYPE_CHECKING:
    from rich.console import RenderableType

    from crowdbot.core.campaign.job import Job, JobOutcome
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.campaign.run import Listener, State

#: Endings that have a column; a campaign has no people alone.
_ENDINGS = shown({})


@contextmanager
def show(plan: Plan) -> Iterator[Listener]:
    """Yield a function that a campaign calls with its state."""
    if logging.getLogger("crowdbot").level > logging.INFO:
        yield _only_failures
        return
    complete = sum(bool(r.status) for r in plan.runs)
    runs, jobs = plural(len(plan.runs), "run"), plural(len(plan.jobs), "job")
    _say(f"{runs}, {complete} complete, {jobs} to do")
    for label, why in plan.left_out.items():
        _say(f"{label} is left out: {why}")
    if hint := known_runs(plan):
        _say(hint)
    lines = _Lines()
    if not sys.stderr.isatty():
        yield lines
    else:
        with _live() as listener:
            yield listener
            lines.state = getattr(listener, "state", None)
    if lines.state is not None:
        _summary(lines.state)


def _only_failures(state: State, job: Job | None, done: JobOutcome | None) -> None:
    """Print failures only, for ``--quiet``."""
    if job is not None and done is not None and (done.error or has_failed(done.status)):
        _say(_line(state, job, done))


class _Lines:
    """Prints a line for each finished job."""

    def __init__(self) -> None:
        self.state: State | None = None
        self._own_first = OwnFirst()

    def __call__(self, state: State, job: Job | None, done: JobOutcome | None) -> None:
        self.state = state
        if job is not None and done is not None:
            _say(_line(state, job, done))
        if line := self._own_first.line(state):
            _say(line)


@contextmanager
def _live() -> Iterator[Listener]:
    from rich.console import Console
    from rich.live import Live

    with Live(console=Console(stderr=True), refresh_per_second=4, transient=True) as live:
        yield _Table(live)


class _Table:
    """Redraws the table on every update."""

    def __init__(self, live: object) -> None:
        self._live = live
        self.state: State | None = None
        self._own_first = OwnFirst()

    def __call__(self, state: State, job: Job | None, done: JobOutcome | None) -> None:
        self.state = state
        if job is not None and done is not None and done.error:
            self._print(f"{job.title}: {_first(done.error)}")
        if line := self._own_first.line(state):
            self._print(line)
        self._live.update(_table(state))  # type: ignore[attr-defined]

    def _print(self, text: str) -> None:
        self._live.console.print(text, markup=False)  # type: ignore[attr-defined]


def _table(state: State) -> RenderableType:
    from rich.box import SIMPLE_HEAD
    from rich.console import Group
    from rich.progress_bar import ProgressBar
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for name in ("planner", "done", "", *_ENDINGS):
        table.add_column(name)
    counts = _counts(state)
    for label in state.plan.labels:
        total = sum(r.label == label for r in state.plan.runs)
        done = sum(counts[label].values())
        bar = ProgressBar(total=total, completed=done, width=20)
        cells = [Text(str(counts[label][c])) for c in _ENDINGS]
        table.add_row(Text(label), f"{done}/{total}", bar, *cells)
    lines = [_busy(b.job, b.progress) for b in state.busy]
    return Group(table, *map(Text, lines), Text(_rate(state)))


def _busy(job: Job, progress: object) -> str:
    t, limit = getattr(progress, "t", 0.0), getattr(progress, "limit", 0.0)
    far = f"{t:.0f} of {limit:.0f} s" if limit else "preparing"
    return f"  {job.title}: {far}"


def _rate(state: State) -> str:
    ended = len(state.plan.jobs) - len(state.left)
    return f"{ended} of {len(state.plan.jobs)} jobs, about {rough_time(state.remaining)} left"


def _line(state: State, job: Job, done: JobOutcome) -> str:
    ended = len(state.plan.jobs) - len(state.left)
    ended_as = "done" if job.kind == "crowd_alone" else done.status  # people cannot be too late
    how = f"failed: {_first(done.error)}" if done.error else ended_as
    left = f", {rough_time(state.remaining)} left" if state.left else ""
    return f"[{ended}/{len(state.plan.jobs)}] {job.title}: {how} ({done.wall_time:.1f} s{left})"


def _counts(state: State) -> dict[str, Counter[str]]:
    counts: dict[str, Counter[str]] = {label: Counter() for label in state.plan.labels}
    for key, status in state.statuses.items():
        counts[state.labels[key]][status] += 1
    return counts


def _summary(state: State) -> None:
    for label, counts in _counts(state).items():
        total = sum(r.label == label for r in state.plan.runs)
        found = ", ".join(f"{counts[c]} {c}" for c in _ENDINGS if counts[c])
        _say(f"{label}: {sum(counts.values())} of {total}: {found}")


def _first(text: str) -> str:
    return text.splitlines()[0] if text else ""


def _say(text: str) -> None:
    say(text, err=True)
