"""Write the site of a challenge: how to take part, scenarios, leaderboard and replays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.leaderboard import write_leaderboard
from crowdbot.core.bundle.manifest import RULES, RULES_TEXT
from crowdbot.core.bundle.standings import Standings
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scoring.four_scores import BESIDE_PRIMARY, MAIN_SCORES
from crowdbot.core.site.pictures import Picture, draw_conditions
from crowdbot.core.site.replays import SiteReplay, write_replays
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import Allowed, render_page
from crowdbot.dsl.suite.expand import Expansion
from crowdbot.dsl.suite.round import Round

INDEX, LEADERBOARD = "index.html", "leaderboard.html"


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """The contents of a site.

    Attributes:
        suite: name of the suite in commands, as the organiser gave it.
        expansion: the suite.
        tables: tables of the leaderboard.
        left_out: name of a bundle -> why it is left out.
    """

    suite: str
    expansion: Expansion
    tables: Sequence[Standings]
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def entries(self) -> list[LeaderboardEntry]:
        """Return all bundles of the tables, in their order."""
        return [entry for table in self.tables for entry in table.entries]

    @property
    def round(self) -> Round:
        """Return the suite's round; one without dates if it has none."""
        return self.expansion.round or Round()

    @property
    def title(self) -> str:
        """Return the suite's title, or its id."""
        return self.expansion.title or self.expansion.suite_id

    @property
    def suite_name(self) -> str:
        """Return the suite's name for a team, without the organiser's folders."""
        return Path(self.suite).name

    @property
    def hidden(self) -> bool:
        """Return True if the suite's draws are not revealed yet."""
        return any(scenario.hidden for scenario in self.expansion.scenarios)


def write_site(folder: Path, site: Site, registry: Registry) -> list[Path]:
    """Write all pages and pictures, and return the files.

    Args:
        folder: folder to write; it is made if needed.
        site: the contents.
        registry: the installed components.

    Raises:
        InputError: a file cannot be written, or a recording of a bundle cannot be read.
    """
    folder.mkdir(parents=True, exist_ok=True)
    pictures = draw_conditions(site.expansion, registry, folder)
    replays = write_replays(site.entries, registry, folder)
    if site.entries:
        write_leaderboard(
            folder / LEADERBOARD, site.tables, site.left_out, f"{site.title}: leaderboard"
        )
    atomic_write(folder / INDEX, _index(site, pictures, replays, registry))
    made = [folder / INDEX, *(folder / p.file for p in pictures if p.file)]
    return made + [folder / r.file for r in replays] + [folder / LEADERBOARD] * bool(site.entries)


def _index(
    site: Site, pictures: Sequence[Picture], replays: Sequence[SiteReplay], registry: Registry
) -> str:
    metrics = registry.components("metric")
    mains = [*MAIN_SCORES, BESIDE_PRIMARY]
    return render_page(
        __package__,
        allowed=Allowed(images="'self'"),
        title=site.title,
        suite=site.suite_name,
        site=site,
        commands=take_part(site),
        pictures=pictures,
        replays=replays,
        scores=[(m.metric, metrics[m.metric].summary) for m in mains if m.metric in metrics],
        rules=RULES_TEXT,
        rules_number=RULES,
        leaderboard=LEADERBOARD if site.entries else "",
        version=metadata.version("crowdbot"),
    )


def take_part(site: Site) -> list[tuple[str, str]]:
    """Return the commands with which a team takes part: what each does, and the command."""
    install = ("Install crowdbot.", "pip install crowdbot")
    campaign = f"crowdbot campaign {site.suite_name} --planner"
    to = f" to {site.round.contact}" if site.round.contact else ""
    if site.round.planners == "sealed" or site.hidden:  # no one can run hidden draws
        practise = f"{campaign} mine.py:Mine{' --set crowd.seed.root=1' if site.hidden else ''}"
        return [
            install,
            (
                "Write a class Mine into mine.py; here is how.",
                "crowdbot docs tutorial/first_planner",
            ),
            ("Try it.", practise),
            (
                f"Seal it, and send the file{to}.",
                "crowdbot seal mine.py:Mine --team 'Us' --out us.cbs",
            ),
        ]
    write = "crowdbot plugins new mine --planner && pip install -e crowdbot-mine"
    bundle = f"crowdbot bundle runs --suite {site.suite_name} --planner mine.give_way"
    return [
        install,
        ("Have a planner written to start from, and change it.", write),
        ("Run your planner in all scenarios.", f"{campaign} mine.give_way"),
        (
            f"Pack and check your runs, and send the file{to}.",
            f"{bundle} --team 'Us' --out us.cbz --check",
        ),
    ]


__all__ = ["INDEX", "LEADERBOARD", "Site", "take_part", "write_site"]
