"""Output of a run: how it ended, why, its four scores and its replay; all scores if asked for."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from crowdbot.cli.output.say import say_json

if TYPE_CHECKING:
    from rich.table import Table

    from crowdbot.core.runs.run import Run
    from crowdbot.core.scoring.scores_csv import RunScore
    from crowdbot.core.types.score import Score

_BETTER = {
    "higher": "higher is better", "lower": "lower is better", "reference": "near people's is best",
}  # fmt: skip
#: Reasons of the four scores without a value, in words; `--all` shows the reasons themselves.
_WORDS = {
    "zero_denominator": "the robot made no progress",
    "no_neighbours": "no one was near the robot",
    "no_agents": "there were no people",
}
#: Number of scores shown where a run has none of the four.
_FEW = 6


def print_result(run: Run, *, as_json: bool, everything: bool) -> None:
    """Print a run on stdout.

    Args:
        as_json: True for its record and scores as JSON.
        everything: True for all scores, otherwise four.
    """
    from crowdbot.core.runs.run_directory import REPLAY, SCORES
    from crowdbot.core.scoring.scores_csv import read_scores_csv

    rows = read_scores_csv(run.directory / SCORES)
    if run.replaced:
        logging.getLogger("crowdbot").info(
            "note: it replaces a run that was recorded differently: %s", ", ".join(run.replaced)
        )
    if as_json:
        say_json(_document(run, rows))
        return
    _print_text(_summary(run), *_causes(run))
    _print_scores(run, [r.score for r in rows], everything)
    _print_text(f"replay: {run.directory / REPLAY}", fold=False)
    if everything:
        _print_text(f"all variants: {run.directory / SCORES}", fold=False)
    elif len(rows) > _FEW:
        _print_text("all scores: the same command with --all")


def _document(run: Run, rows: Sequence[RunScore]) -> dict[str, Any]:
    names = ("metric", "variant", "value", "unit", "status", "reason", "lower", "upper")
    return {
        **run.record.document(),
        "directory": str(run.directory),
        "reused": run.reused,
        "replaced": list(run.replaced),
        "scores": [{name: getattr(r.score, name) for name in names} for r in rows],
    }


def _print_text(*lines: str, fold: bool = True) -> None:
    """Print lines, wrapped between words; with ``fold=False`` unwrapped, as for paths."""
    from rich.console import Console

    for line in lines:
        Console().print(line, soft_wrap=not fold, highlight=False, markup=False)


def _print_scores(run: Run, scores: Sequence[Score], everything: bool) -> None:
    from rich.console import Console

    from crowdbot.core.scoring.scores_csv import headlines, scores_table

    shown = headlines(scores)
    if run.record.people_alone:  # nothing about a robot has a value
        shown = [score for score in shown if score.status == "ok"]
    if not shown:
        return
    Console().print(scores_table(shown) if everything else _few(shown))


def _few(shown: Sequence[Score]) -> Table:
    """Return a table of the four main scores, or of the first scores if there are none."""
    from rich.table import Table
    from rich.text import Text

    from crowdbot.core.scoring.four_scores import MAIN_SCORES, is_main
    from crowdbot.core.scoring.scores_csv import verdict

    roles = {s.metric: s.role for s in MAIN_SCORES}
    main = [s for s in shown if is_main(s.metric, s.variant)]
    table = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False, show_header=False)
    for s in main or shown[:_FEW]:
        score = replace(s, reason=_WORDS.get(s.reason, s.reason)) if s in main else s
        cells = (roles.get(s.metric, s.metric), verdict(score), _BETTER.get(s.better, ""))
        table.add_row(*map(Text, cells), style="" if s.status == "ok" else "dim")
    return table


def _causes(run: Run) -> Iterator[str]:
    """Yield the decisive moment of each robot in words, if the recording shows one."""
    from crowdbot.core.why.explain import explain
    from crowdbot.errors import InputError

    if run.record.people_alone:
        return
    for robot in run.record.robots or (None,):
        try:
            found = explain(run.directory, robot, sensors=False)
        except InputError:  # it ended before there was anything to explain
            continue
        name = f"{robot}: " if robot else ""
        yield f"{name}{'; '.join(found.sentences)}"


def _summary(run: Run) -> str:
    from crowdbot.core.runs.provenance import remarks

    record = run.record
    when = record.goal_time or record.sim_time
    ending = record.status.sentence.format(t=when)
    if record.people_alone:
        ending = f"people walked alone for {record.sim_time:.1f} s"
    speed = f"{record.real_time_factor:.1f} times real time"
    note = "; was complete already, --force runs it again" if run.reused else f" ({speed})"
    title = f"{record.scenario} · {record.planner.name} · seed {record.seed}"
    flags = "".join(f"; {flag.lower()}" for flag in remarks(record))
    return f"{title}: {ending}{note}{flags}"
