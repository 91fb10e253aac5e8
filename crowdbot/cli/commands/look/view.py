"""``crowdbot view``: draw a scenario from above before it is run, or open the replay of a run."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.serving.serve_arguments import AllowOrigin
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, ScenarioSet, check_ending, installed
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.text import listed
from crowdbot.errors import InputError, UsageError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.replay.shown_run import ShownRun
    from crowdbot.core.view.shapes import Drawing

_FORMATS = (".html", ".svg", ".png")


def view(
    spec: Annotated[str, argument("SPEC|RUN_DIR", "File, name of a suite, or a run.")],
    others: Annotated[
        list[str] | None,
        argument(
            "[ID|RUN_DIR ...]",
            "Scenario: id, unique beginning, or pattern. Or more runs, to compare.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        option("FILE", "File to write: .html, .svg, .png; default: ID.html; of runs compare.html."),
    ] = None,
    open_: Annotated[bool, switch("--open", "Show it in the browser.")] = False,
    overrides: ScenarioSet = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    foxglove: Annotated[
        int | None,
        typer.Option(min=0, max=65535, metavar="PORT", help="Play a run in Foxglove; 0: any port."),
    ] = None,
    allow_origin: AllowOrigin = None,
    reference: Annotated[
        str | None,
        option("crowdbot|FILE|ROOT", "Show a run's place among these reference scores."),
    ] = None,
    as_json: Annotated[bool, switch("--json", "Path and facts as JSON.")] = False,
) -> None:
    """Draw a scenario from above; find the replay page of a run, or compare runs on one page.

    Nothing is simulated.

    With --foxglove a run is played in Foxglove, with Foxglove's own controls.

    Example: crowdbot view challenge-2020 counter-d0500-fast-c20-r05 --out scenario.png

    Example: crowdbot view runs/a/dwa/seed-0 runs/a/stop_and_go/seed-0 --out compare.html

    Example: crowdbot view runs/a/dwa/seed-0 --reference crowdbot
    """
    if foxglove is not None:
        _play(Path(spec), foxglove, allow_origin or ())
        return
    facts: dict[str, str] = {}
    if Path(spec).is_dir():
        if overrides:
            raise UsageError(f"{spec} is a run, which is over: no --set")
        names = [spec, *(others or [])]
        path = _replay(names, out, reference, lambda: installed(plugin, no_plugins))
    else:
        if reference is not None:
            raise UsageError(f"{spec} is not a run: --reference shows the place of one")
        if len(others or []) > 1:
            raise UsageError(f"one ID is drawn at a time, and {others} are several")
        pattern = next(iter(others or []), None)
        path, facts = _render_map(
            installed(plugin, no_plugins), spec, pattern, out, overrides or []
        )
    if as_json:
        say_json({"path": str(path), "facts": facts}, ensure_ascii=False)
    else:
        say(path)
    if open_:
        typer.launch(str(path.resolve()))


def _play(run: Path, port: int, origins: Sequence[str]) -> None:
    """Serve a run's recording to Foxglove until Ctrl-C."""
    from crowdbot.cli.serving.serve_options import needs
    from crowdbot.core.runs.run_directory import RECORDING

    recording = run / RECORDING if run.is_dir() else run
    if not recording.is_file():
        raise InputError(f"{run}: --foxglove plays a run, or its recording; there is none")
    needs("live", "foxglove")
    from crowdbot.core.live.admission import Admission
    from crowdbot.core.live.foxglove.playback import FoxglovePlayback

    admission = Admission(server="foxglove", origins=origins)
    player = FoxglovePlayback(recording, "127.0.0.1", port, admission)
    say(f"foxglove: ws://127.0.0.1:{player.port} (Ctrl-C ends it)", err=True)
    with suppress(KeyboardInterrupt):
        threading.Event().wait()
    player.close()


def _replay(
    names: list[str], out: Path | None, reference: str | None, registry: Callable[[], Registry]
) -> Path:
    """Return the path of a replay page: the run's own, or a new one if anything else is asked."""
    folders = [Path(name) for name in names]
    for folder in folders:
        if not folder.is_dir():
            raise UsageError(f"{folder} is not a run directory, and {folders[0]} is one")
    if len(folders) == 1 and out is None and reference is None:
        return _own_page(folders[0])
    check_ending(out, ".html")
    from crowdbot.core.replay.page import write_replay
    from crowdbot.core.runs.replayed import replayed_runs

    shown = replayed_runs(folders, registry())
    if reference is not None:
        shown = _among(shown, folders, reference)
    path = out or Path("compare.html")
    scenario = shown[0].facts["Scenario"]
    write_replay(path, *shown, title=f"{scenario} · {listed([one.label for one in shown])}")
    return path


def _among(shown: Sequence[ShownRun], folders: Sequence[Path], reference: str) -> list[ShownRun]:
    """Add the fact "Among references" to each run: its rank among the reference scores."""
    from crowdbot.core.results.with_reference import place_of_run, reference_results
    from crowdbot.core.runs.run_record import RunRecord

    given = reference_results(reference)
    places = [
        place_of_run(RunRecord.read(folder), one.scores, given)
        for folder, one in zip(folders, shown, strict=True)
    ]
    return [
        replace(one, facts={**one.facts, "Among references": place})
        for one, place in zip(shown, places, strict=True)
    ]


def _own_page(run: Path) -> Path:
    from crowdbot.core.runs.run_directory import RECORD, REPLAY

    if not (run / RECORD).is_file():
        raise InputError(f"{run}: no run directory, there is no {RECORD} in it")
    if not (run / REPLAY).is_file():
        raise InputError(
            f"{run}: the run has no {REPLAY}; crowdbot view {run} --out {REPLAY} makes one"
        )
    return run / REPLAY


def _render_map(
    registry: Registry, spec: str, pattern: str | None, out: Path | None, overrides: list[str]
) -> tuple[Path, dict[str, str]]:
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.core.scenarios.lock import population
    from crowdbot.core.view.build import build_map_content
    from crowdbot.core.view.facts import scenario_facts
    from crowdbot.core.view.render import render
    from crowdbot.dsl.identity.canonical import content_hash

    check_ending(out, *_FORMATS)
    expansion = open_spec(spec, registry, overrides)
    chosen = pick(expansion, pattern)
    people = population(chosen, registry)
    spec_hash = content_hash(chosen, registry.spec_versions(chosen))
    facts = scenario_facts(chosen, people.agents, spec_hash)
    title = chosen.id if expansion.single else f"{expansion.suite_id}/{chosen.id}"
    path = out or Path(f"{chosen.id.replace('/', '_')}.html")
    content = build_map_content(chosen, people.agents, registry)
    heading = path.suffix.lower() != ".html"
    atomic_write(
        path, _serialise(render(content, title, facts, heading=heading), path.suffix.lower())
    )
    return path, facts


def _serialise(drawing: Drawing, suffix: str) -> bytes:
    if suffix == ".png":
        from crowdbot.core.view.png import to_png

        return to_png(drawing)
    if suffix == ".svg":
        from crowdbot.core.view.svg import to_svg

        return to_svg(drawing).encode()
    from crowdbot.core.view.page import to_html

    return to_html(drawing).encode()
