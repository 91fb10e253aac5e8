"""``crowdbot info``: show the contents of a recording."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from crowdbot.cli.output.say import say_json
from crowdbot.cli.shared.option import argument
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.errors import InputError, printable

if TYPE_CHECKING:
    from crowdbot.core.recording.reading.contents import RecordingContents
    from crowdbot.core.recording.recording import Recording


def info(
    file: Annotated[Path, argument("FILE|RUN_DIR", "A recording, or a run directory.")],
    as_json: AsJson = False,
) -> None:
    """Show the contents of a recording: topics with rates and sizes, duration, hash, completeness.

    Example: crowdbot info runs/challenge-2020/in-d0125-slow-c01-r02/dwa/seed-0/run.mcap
    """
    from crowdbot.core.recording.reading.contents import contents
    from crowdbot.core.runs.run_directory import RECORDING

    path = file / RECORDING if file.is_dir() else file
    if not path.is_file() and (file / "metadata.yaml").is_file():
        raise InputError(f"{file} is a bag for ROS: 'ros2 bag info {file}' describes it")
    found = contents(path)
    about = _about(path, found)
    if as_json:
        topics = [
            {
                "topic": t.name, "type": t.msgtype, "messages": t.count, "rate": t.rate,
                "bytes": t.size,
            }
            for t in found.topics
        ]  # fmt: skip
        say_json({**about, "topics": topics})
        return
    _show(about, found)


def _about(path: Path, contents: RecordingContents) -> dict[str, Any]:
    from crowdbot.core.recording.recording import Recording

    about: dict[str, Any] = {
        "file": str(path),
        "bytes": contents.size,
        "duration": contents.end,
        "finished": contents.finished,
        "complete": contents.complete,
        "status": contents.status,
        "messages": sum(t.count for t in contents.topics),
        "attachments": dict(contents.attachments),
    }
    if any(t.name == "/crowdbot/header" for t in contents.topics):
        with Recording(path) as recording:
            scenario = recording.header.scenario
            about |= {"scenario": scenario, "trajectory": _hash(recording)}
    return about


def _hash(recording: Recording) -> str | None:
    """Return the trajectory hash; None without samples."""
    from crowdbot.core.runs.read_and_score import recorded_run

    try:
        return recorded_run(recording).trajectory
    except InputError:
        return None


def _show(about: dict[str, Any], contents: RecordingContents) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    def escaped(text: str) -> str:
        return escape(printable(text))

    console = Console(soft_wrap=True, highlight=False)
    ending = "complete" if contents.complete else "NOT complete"
    if not contents.finished:
        ending += ": the file was cut off; crowdbot recover makes a whole one of it"
    elif contents.status and not contents.complete:
        ending += f": {printable(contents.status)}"
    console.print(
        f"{printable(about['file'])}: {contents.size} bytes, {contents.end:.2f} s, {ending}",
        markup=False,
    )
    for name in ("scenario", "trajectory"):
        if about.get(name):
            console.print(printable(f"{name}: {about[name]}"), markup=False)
    table = Table(box=None, pad_edge=False)
    for name in ("topic", "type", "messages", "Hz", "bytes"):
        table.add_column(name, overflow="fold", no_wrap=name not in ("topic", "type"))
    for topic in contents.topics:
        rate = "" if topic.rate is None else f"{topic.rate:.1f}"
        table.add_row(
            *map(escaped, (topic.name, topic.msgtype)), str(topic.count), rate, str(topic.size)
        )
    console.print(table)
    for name, size in contents.attachments.items():
        console.print(printable(f"attached: {name}, {size} bytes"), markup=False)
