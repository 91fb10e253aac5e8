"""``crowdbot seal``: pack a planner's files to hand it in."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option
from crowdbot.cli.shared.options import NoPlugins, Plugins, check_ending, installed
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.text import plural
from crowdbot.errors import InputError, printable


def seal(
    planner: Annotated[str, argument("FILE.py:CLASS|FILE.yaml", "The planner.")],
    out: Annotated[Path | None, option("FILE", "File to write, .cbs; default: NAME.cbs.")] = None,
    planner_set: Annotated[
        list[str] | None, option("KEY=VALUE", "Parameter of the planner; repeatable.")
    ] = None,
    include: Annotated[
        list[str] | None, option("PATTERN", "More files beside it, such as data; repeatable.")
    ] = None,
    environment: Annotated[str, option("FILE", "File beside it that lists needed libraries.")] = "",
    team: Annotated[str, option("TEXT", "Name of the team.")] = "",
    contact: Annotated[str, option("TEXT", "How to reach the team.")] = "",
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Seal a planner: its files in one archive, whose hash fixes it before draws are revealed.

    Modules beside the planner that it imports are included; name its data with --include. The
    sealed copy is loaded once, to check that nothing is missing.

    Example: crowdbot seal mine.py:Mine --include 'weights/*' --team 'Us' --out us.cbs
    """
    from crowdbot.core.bundle.manifest import name_problem
    from crowdbot.core.bundle.submission import About, unpack_submission, write_submission
    from crowdbot.core.planning.choice import PlannerPlace
    from crowdbot.core.planning.planner_files import planner_files
    from crowdbot.core.planning.resolve import resolve_planner

    for flag, text in (("--team", team), ("--contact", contact)):
        if problem := name_problem(text):
            raise InputError(f"{flag} {printable(text[:60])!r}: {problem}")
    registry = installed(plugin, no_plugins)
    choice = resolve_planner(planner, registry, planner_set or ())
    files = planner_files(planner, [*(include or ()), *([environment] if environment else [])])
    name = Path(planner).name
    about = About(
        team=team, contact=contact, planner=name, settings=list(planner_set or ()),
        digest=choice.digest, environment=environment, files={},
    )  # fmt: skip
    target = out or Path(f"{choice.name}.cbs")
    check_ending(target, ".cbs")
    sealed = write_submission(target, about, files)
    with tempfile.TemporaryDirectory(prefix="crowdbot-sealed-") as folder:
        _, colon, kind = name.partition(":")
        copy = f"{unpack_submission(sealed, Path(folder))}{colon}{kind}"
        try:
            place = PlannerPlace(sealed=Path(folder))
            again = resolve_planner(copy, registry, planner_set or (), place)
        except InputError as error:
            target.unlink()
            raise InputError(f"the sealed copy does not load: {error}; see --include") from None
    if again.digest != choice.digest:
        target.unlink()
        raise InputError("the sealed copy is another planner: a file is missing; see --include")
    if as_json:
        say_json({"file": str(target), "sha256": sealed.sha256, **sealed.about.model_dump()})
        return
    say(f"{target}: {plural(len(files), 'file')}, sha256 {sealed.sha256}")
