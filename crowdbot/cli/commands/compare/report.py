"""``crowdbot report``: build one offline page about the runs of a suite."""

from __future__ import annotations

import logging
import os
import shlex
import sys
from collections.abc import Sequence
from dataclasses import asdict, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from urllib.parse import quote

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.open_results import Altered, Reference, open_results, suite_id
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, check_ending, installed
from crowdbot.core.support.text import plural
from crowdbot.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from crowdbot.core.report.contents import Contents
    from crowdbot.core.results.confounds import Finding
    from crowdbot.core.results.results import Results
    from crowdbot.core.statistics.audit import Audit
    from crowdbot.core.statistics.floors import FloorCheck

#: Number of damaged runs that are named.
_SHOWN = 3


def report(
    root: Annotated[Path, argument("[ROOT]", "Where campaigns and simulations put runs.")] = Path(
        "runs"
    ),
    suite: Annotated[
        str | None, option("SPEC", "Which suite, if there are several: its id or file.")
    ] = None,
    planner: Annotated[
        list[str] | None, option("GLOB", "Only planners with such labels; repeatable.")
    ] = None,
    reference: Reference = None,
    out: Annotated[
        Path, option("FILE", "File to write, .html; .csv and .md lie beside it.")
    ] = Path("report.html"),
    accept: Annotated[
        list[str] | None,
        option("CONFOUND", "Compare although runs differ in this; the page says so; repeatable."),
    ] = None,
    audit: Annotated[
        Path | None, option("FILE", "Audit of the suite; default: ROOT/ID/audit.json.")
    ] = None,
    no_replay_links: Annotated[
        bool, switch("--no-replay-links", "Leave out links to replays, for a page that is moved.")
    ] = False,
    latex: Annotated[
        bool, switch("--latex", "Also write tables for LaTeX, .tex, and a figure, .pdf and .svg.")
    ] = False,
    altered: Altered = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "What was written, as JSON.")] = False,
) -> None:
    """Write one offline page with the scores of planners, and its CSV and Markdown beside it.

    Example: crowdbot report runs --suite challenge-2020 --planner 'dwa*' --out report.html
    """
    from crowdbot.core.report.contents import Heading, gather
    from crowdbot.core.report.page import write_report
    from crowdbot.core.report.paper import write_paper
    from crowdbot.core.results.chosen_planners import of_planners
    from crowdbot.core.results.confounds import check_comparable, confounds
    from crowdbot.core.results.with_reference import reference_results, with_reference

    check_ending(out, ".html")
    registry = installed(plugin, no_plugins)
    suite_name = None if suite is None else suite_id(suite, registry)
    own = _of_suite(open_results(root, altered), suite_name, root)
    given = None if reference is None else reference_results(reference)
    results, known = with_reference(own, given)
    results = of_planners(results, planner or ())
    if not results.runs:
        raise InputError(f"{root}: no complete run of {', '.join(planner or ())}")
    known = tuple(k for k in known if k in {r.planner for r in results.runs})
    links = {} if no_replay_links else _replays(own, root, out)
    findings = confounds(results, accept or ())
    check_comparable(findings)
    heading = Heading(
        suite=results.runs[0].suite,
        made=f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        command=shlex.join(["crowdbot", *sys.argv[1:]]),
        accepted=tuple(str(f) for f in findings if f.accepted),
        warnings=(*(str(f) for f in findings if not f.accepted), *_left_out(results)),
        references=known,
        audit=_audit(audit, root / results.runs[0].suite),
    )
    contents = gather(results, registry, heading, links)
    paths = write_report(out, contents)
    if latex:
        paths |= write_paper(out, contents)
    _tell(paths, contents, findings, as_json)


def _left_out(results: Results) -> list[str]:
    """Return the page's text about damaged runs."""
    lost = [d.directory for d in results.damaged]
    some = ", ".join(lost[:_SHOWN]) + (", …" if len(lost) > _SHOWN else "")
    return [f"damaged: {plural(len(lost), 'run')} left out: {some}"] if lost else []


def _of_suite(results: Results, suite: str | None, root: Path) -> Results:
    """Return the runs of one suite.

    Raises:
        InputError: there are no runs, or several suites.
        UnknownNameError: no run has such a suite.
    """
    suites = results.suites
    if not results.runs:
        raise InputError(f"{root}: there is no complete run below it")
    if suite is None and len(suites) > 1:
        raise InputError(
            f"{root}: runs of several suites, choose with --suite: {', '.join(suites)}"
        )
    chosen = suite if suite is not None else suites[0]
    if chosen not in suites:
        raise UnknownNameError("suite", chosen, suites)
    from crowdbot.core.results.score_columns import of_runs

    runs = tuple(r for r in results.runs if r.suite == chosen)
    return replace(
        results,
        runs=runs,
        scores=of_runs(results.scores, {r.run_id for r in runs}),
        failures=tuple(f for f in results.failures if f.suite == chosen),
    )


def _audit(given: Path | None, folder: Path) -> Audit | None:
    """Return the given audit, or the one beside the runs.

    Raises:
        InputError: it cannot be read.
    """
    from crowdbot.core.statistics.audit import AUDIT, read_audit

    path = given or folder / AUDIT
    return read_audit(path) if given or path.is_file() else None


def _replays(results: Results, root: Path, out: Path) -> dict[str, str]:
    """Return run id -> address of its replay page relative to the report, if it exists."""
    from crowdbot.core.runs.run_directory import REPLAY

    pages = {r.run_id: f"{root}/{r.directory}/{REPLAY}" for r in results.runs}
    here = out.resolve().parent
    return {
        run_id: quote(Path(os.path.relpath(Path(page).resolve(), here)).as_posix())
        for run_id, page in pages.items()
        if os.path.isfile(page)  # noqa: PTH113  many files: a Path takes longer
    }


def _tell(
    paths: dict[str, Path], contents: Contents, findings: Sequence[Finding], as_json: bool
) -> None:
    quiet = logging.getLogger("crowdbot").level > logging.INFO
    for finding in findings:
        if quiet and finding.accepted:
            continue
        say(f"{'accepted' if finding.accepted else 'warning'}: {finding.brief}", err=True)
    if not as_json:
        if not quiet:
            _tell_of(contents)
        for name in ("html", "tex", "pdf", "svg"):
            if name in paths:
                say(paths[name])
        return
    document = {
        **{name: str(path) for name, path in paths.items()},
        "suite": contents.heading.suite,
        "planners": contents.planners,
        "runs": contents.counts(),
        "accepted": contents.heading.accepted,
        "warnings": contents.heading.warnings,
        "floors": [
            {"planner": c.planner, "beats_floors": c.beats_all, "text": c.text}
            for c in contents.floors
        ],
        "suspicion": contents.suspicion,
        "sample": None if contents.sample is None else asdict(contents.sample),
        "crowds": contents.crowds,
        "ranks_by_crowd": None if contents.ranks is None else contents.ranks.as_json(),
    }
    say_json(document, ensure_ascii=False)


def _of_floors(checks: Sequence[FloorCheck]) -> list[str]:
    """Return the comparison with floors: a line per planner, or one if all are undecided."""
    reasons = {check.undecided for check in checks}
    if len(checks) > 1 and len(reasons) == 1 and "" not in reasons:
        return [f"no planner can be told from the floors: {reasons.pop()}; the page has the leads"]
    return [check.text for check in checks]


def _tell_of(contents: Contents) -> None:
    """Print the page's main findings on stderr."""
    counts = contents.counts()
    counted = ", ".join(f"{n} {name.replace('_', ' ')}" for name, n in counts.items() if n)
    say(f"{', '.join(contents.planners)}: {counted}", err=True)
    ranks = contents.ranks.verdicts if contents.ranks else ()
    lines = [
        *(f"crowd: {line}" for line in contents.crowds),
        contents.suspicion,
        contents.sample.text if contents.sample else "",
        *_of_floors(contents.floors),
        *(verdict.text for verdict in ranks),
    ]
    say("\n".join(text for text in lines if text), err=True)
