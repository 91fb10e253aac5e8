"""``crowdbot import``: convert scenes of other simulators to scenarios, with a report of losses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import argument, option, switch

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crowdbot.core.exchange.importing import Imported


def import_(
    files: Annotated[
        list[Path],
        argument(
            "FILE...",
            "Files that belong together: trials of the original, UMANS XML, other programs.",
        ),
    ],
    out: Annotated[
        Path | None, option("FILE", "File to write, .yaml; default: NAME.yaml, here.")
    ] = None,
    homography: shared.PixelsToMetres = None,
    frame_rate: shared.FrameRate = None,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "The whole report as JSON.")] = False,
) -> None:
    """Convert scenes of other simulators to scenarios; report the outcome for each part.

    Example: crowdbot import Circle10.xml RVO.xml --out circle.yaml

    Example: crowdbot import Wheelchair_demo_config.xml --out wheelchair.yaml

    Example: crowdbot import tracks.csv --homography H.txt --frame-rate 25
    """
    from crowdbot.core.exchange.checked import write
    from crowdbot.core.exchange.importing import import_files
    from crowdbot.core.trajectories.data_sets.homography import video_scale

    shared.check_ending(out, ".yaml", ".yml")
    scale = video_scale(homography, frame_rate)
    target = out or Path(f"{files[0].stem}.yaml")
    found = import_files(files, target.stem, shared.installed(plugin, no_plugins), scale)
    written = write(target, found.lines, found.scenes)
    say(json.dumps(_facts(found, written), indent=2) if as_json else _text(found, written))


def _facts(imported: Imported, written: Sequence[Path]) -> dict[str, Any]:
    return {
        "out": str(written[0]),
        "files": [str(path) for path in written],
        "formats": imported.formats,
        "scenarios": imported.ids,
        "counts": imported.report.counts(),
        "report": [entry.as_dict() for entry in imported.report.entries],
    }


def _text(imported: Imported, written: Sequence[Path]) -> str:
    count = len(imported.ids)
    scenarios = f"{count} scenario{'s' * (count != 1)}: {', '.join(imported.ids[:5])}"
    more = ", …" if count > 5 else ""
    return "\n".join([*imported.report.lines(), f"wrote {written[0]}, {scenarios}{more}"])
