"""``crowdbot study``: plan and run a study with people, and compare its conditions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, check_ending, installed
from crowdbot.core.support.text import plural

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.studies.document import Study

study = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
_File = Annotated[Path, argument("STUDY", "The study's YAML file.")]
_Data = Annotated[
    Path | None, option("DIR", "Folder of the study's data; default: beside it, -data.")
]
_Json = Annotated[bool, switch("--json", "JSON on stdout.")]


@study.callback()
def about() -> None:
    """Plan and run a study with people, and compare its conditions.

    Example: crowdbot study run study.yaml --participant p01
    """


@study.command()
def plan(
    file: _File,
    data: _Data = None,
    orders: Annotated[
        Path | None, option("DIR", "Write an order file for each participant there.")
    ] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Check a study; show the order of each participant, how balanced orders are, and progress.

    Example: crowdbot study plan study.yaml --orders orders
    """
    from dataclasses import asdict

    from crowdbot.core.studies.orders import balance, write_order_files
    from crowdbot.core.studies.summary import participant_states

    found, _ = _opened(file, plugin, no_plugins)
    states = participant_states(found, _data(file, data))
    places, after = balance([s.order for s in states])
    written = write_order_files(found, orders) if orders is not None else []
    if as_json:
        document = {
            "study": found.spec.id,
            "participants": [asdict(s) for s in states],
            "unequal_places": places,
            "unequal_successions": after,
            "order_files": [str(p) for p in written],
        }
        say_json(document)
        return
    for s in states:
        say(f"{s.participant}: {' '.join(s.order)}; {s.done} of {s.count} steps")
    say(_balance_text(places, after))
    if written:
        say(f"wrote {plural(len(written), 'order file')} to {orders}")


@study.command()
def run(
    file: _File,
    participant: Annotated[str | None, option("ID", "Pseudonym of the participant.")] = None,
    synthetic: Annotated[
        bool, switch("--synthetic", "Synthetic users drive; without --page forms stay open.")
    ] = False,
    page: Annotated[
        bool, switch("--page", "With --synthetic: show the page all the same.")
    ] = False,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port of the page; 0: a free one.")
    ] = 0,
    data: _Data = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
) -> None:
    """Lead a participant through the study, on a page that this machine alone can open.

    Every finished step is kept: after an interruption the same command continues.

    Example: crowdbot study run study.yaml --participant p01

    Example: crowdbot study run study.yaml --synthetic
    """
    from crowdbot.core.studies.headless import finish_all
    from crowdbot.core.studies.progress import open_progress
    from crowdbot.errors import UsageError

    if participant is None and (page or not synthetic):
        raise UsageError("who takes part? --participant ID; --synthetic alone runs all")
    found, registry = _opened(file, plugin, no_plugins)
    folder = _data(file, data)
    if synthetic and not page:
        for one in [participant] if participant else found.spec.people:
            progress = open_progress(found, folder, one)
            finish_all(progress, registry, lambda text: say(text, err=True))
        say(f"wrote {folder}")
        return
    assert participant is not None
    from crowdbot.cli.serving.study_page import serve_participant

    progress = open_progress(found, folder, participant)
    serve_participant(progress, registry, port=port, synthetic=synthetic)


@study.command()
def results(
    file: _File,
    out: Annotated[Path | None, option("FILE", "File to write, .csv: the table.")] = None,
    data: _Data = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Join drives, scores and questionnaires in one table, a line for each drive.

    Example: crowdbot study results study.yaml --out results.csv
    """
    from crowdbot.core.results.tables import write_csv
    from crowdbot.core.studies.table import study_rows

    if out is not None:
        check_ending(out, ".csv")
    found, registry = _opened(file, plugin, no_plugins, check=False)
    rows = study_rows(found, _data(file, data), registry)
    if out is not None:
        write_csv(out, rows)
    if as_json:
        say_json(rows)
        return
    for condition in found.spec.conditions:
        own = [r for r in rows if r["condition"] == condition]
        people = len({r["participant"] for r in own})
        say(f"{condition}: {plural(len(own), 'drive')} of {plural(people, 'participant')}")
    if out is not None:
        say(f"wrote {out}")


@study.command()
def report(
    file: _File,
    out: Annotated[Path, option("FILE", "File to write, .html: the page.")] = (Path("study.html")),
    scores: Annotated[
        list[str] | None, option("METRIC.VARIANT", "Score to compare; repeatable.")
    ] = None,
    data: _Data = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: _Json = False,
) -> None:
    """Compare conditions, with participants as the random factor, on one offline page.

    Example: crowdbot study report study.yaml --out study.html
    """
    from crowdbot.core.studies.report.report import as_document, findings_of, write_study_report
    from crowdbot.core.studies.table import study_rows

    check_ending(out, ".html")
    found, registry = _opened(file, plugin, no_plugins, check=False)
    rows = study_rows(found, _data(file, data), registry)
    findings = findings_of(found, rows, scores or ())
    write_study_report(out, found, rows, findings, registry)
    if as_json:
        say_json(as_document(findings))
        return
    drives = plural(len(rows), "drive")
    say(f"{drives}, {plural(len(findings), 'score')} compared; wrote {out}")


def _opened(
    file: Path, plugin: Sequence[Path] | None, no_plugins: bool, *, check: bool = True
) -> tuple[Study, Registry]:
    from crowdbot.core.studies.document import read_study

    registry = installed(plugin, no_plugins)
    return read_study(file, registry if check else None), registry


def _data(file: Path, data: Path | None) -> Path:
    return data or file.with_name(f"{file.stem}-data")


def _balance_text(places: int, after: int) -> str:
    if places == after == 0:
        return "balanced: each condition is as often in each place, and after each other one"
    parts = [f"places differ by {places}"] * bool(places)
    parts += [f"successions differ by {after}"] * bool(after)
    return f"not balanced: {', '.join(parts)}; another number of participants may be"
