"""``crowdbot export-trial``: a scenario as a trial of the original, with a report."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.options import NoPlugins, Plugins, ScenarioSet, check_ending, installed
from crowdbot.cli.shared.run_arguments import ScenarioArgument, SpecArgument


def export_trial(
    spec: SpecArgument,
    scenario: ScenarioArgument = None,
    out: Annotated[
        Path | None, option("FILE", "File to write, .xml; default: ID.xml, here.")
    ] = None,
    overrides: ScenarioSet = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, switch("--json", "The whole report as JSON.")] = False,
) -> None:
    """Write a scenario as trial XML of the original CrowdBot simulator, with its policies.

    Example: crowdbot export-trial challenge-2020 in-d0125-slow-c20-r05 --out trial1.xml
    """
    from crowdbot.core.exchange.trial_export.document import export_trial as write
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.core.support.atomic_write import atomic_write

    check_ending(out, ".xml")
    registry = installed(plugin, no_plugins)
    chosen = pick(open_spec(spec, registry, overrides or []), scenario)
    made = write(chosen, registry)
    target = out or Path(f"{chosen.id.replace('/', '_')}.xml")
    files = {target: made.text}
    if made.policies:
        files[target.with_name(f"{target.stem}.policies.xml")] = made.policies
    for path, text in files.items():
        atomic_write(path, text)
    if as_json:
        entries = [entry.as_dict() for entry in made.report.entries]
        say_json({"files": [str(p) for p in files], "report": entries})
        return
    for entry in made.report.entries:
        say(f"{entry.ours}: {entry.note}")
    for path in files:
        say(f"wrote {path}")
