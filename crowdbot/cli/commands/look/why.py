"""``crowdbot why``: explain why a run, or the runs of a campaign, ended as they did."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.open_results import Altered, open_results
from crowdbot.cli.shared.option import argument, option
from crowdbot.cli.shared.options import check_ending
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.text import plural
from crowdbot.errors import InputError, UsageError

if TYPE_CHECKING:
    from crowdbot.core.why.explain import CauseCount, Explanation


def why(
    path: Annotated[Path, argument("RUN|RUNS", "A run, or a folder of runs.")],
    robot: Annotated[str | None, option("NAME", "Which robot, in a run of several.")] = None,
    planner: Annotated[
        list[str] | None, option("LABEL", "Of a folder: only this planner; repeatable.")
    ] = None,
    out: Annotated[
        Path | None, option("FILE", "File to write, .html: with pictures from above.")
    ] = None,
    altered: Altered = False,
    as_json: AsJson = False,
) -> None:
    """Explain why runs ended as they did: the decisive moment, who was involved, what was seen.

    Example: crowdbot why runs/challenge-2020/in-d0125-slow-c01-r02/dwa/seed-0 --out why.html
    """
    from crowdbot.core.runs.run_directory import RECORD
    from crowdbot.core.why.explain import common_causes, explain

    check_ending(out, ".html")
    if (path / RECORD).is_file():
        if planner:
            raise UsageError(f"--planner is for a folder of runs, and {path} is one run")
        one = explain(path, robot)
        _write(out, one.title, [one], [])
        _tell([one.as_json()] if as_json else [one.title, *one.sentences], out, as_json)
        return
    if robot is not None:
        raise UsageError(f"--robot: {path} is not a run; name a run directory")
    counts, left_out = common_causes(_watched(_directories(path, planner or (), altered)))
    for text in left_out[:3]:
        say(f"left out: {text}", err=True)
    if not counts:
        raise InputError(f"{path}: there is no run with a robot below it")
    _write(out, f"Causes in {path}", [c.example for c in counts], counts)
    if as_json:
        _tell([_count(c) for c in counts], out, as_json)
    else:
        _tell([f"{c.line}; e.g. {c.example.directory}" for c in counts], out, as_json)


def _directories(root: Path, planners: Sequence[str], altered: bool) -> list[Path]:
    from crowdbot.errors import UnknownNameError

    runs = open_results(root, altered).runs
    known = {run.planner for run in runs}
    for name in planners:
        if name not in known:
            raise UnknownNameError("planner", name, known)
    return [root / r.directory for r in runs if not planners or r.planner in planners]


def _watched(directories: Sequence[Path]) -> Iterable[Path]:
    """Return the directories; iterating over them shows a progress bar on a terminal."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    if not console.is_terminal:
        return directories
    title = f"reading {plural(len(directories), 'run')}"
    return track(directories, title, console=console, transient=True)


def _count(cause: CauseCount) -> dict[str, object]:
    return {
        "planner": cause.planner,
        "cause": str(cause.cause),
        "count": cause.count,
        "runs": cause.runs,
        "example": cause.example.as_json(),
    }


def _write(
    out: Path | None, title: str, shown: Sequence[Explanation], counts: Sequence[CauseCount]
) -> None:
    if out is not None:
        from crowdbot.core.why.page import render

        atomic_write(out, render(title, shown, counts, out))


def _tell(lines: Sequence[object], out: Path | None, as_json: bool) -> None:
    if as_json:
        say_json(lines, ensure_ascii=False)
        return
    say("\n".join(map(str, lines)))
    if out is not None:
        say(f"wrote {out}")
