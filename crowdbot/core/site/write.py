"""Write the site of a challenge: how to take part, scenarios, leaderboard and replays."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from importlib import metadata
from pathlib import Path

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.leaderboard import write_leaderboard
from crowdbot.core.bundle.manifest import RULES, RULES_TEXT
from crowdbot.core.bundle.standings import Standings
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scoring.four_scores import MAIN_SCORES, SHOWN
from crowdbot.core.site.copies import copy_suite, with_copies
from crowdbot.core.site.pictures import Picture, draw_conditions
from crowdbot.core.site.replays import SiteReplay, write_replays
from crowdbot.core.statistics.sample_size import least_draws
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.html_page import Allowed, render_page
from crowdbot.core.support.text import plural
from crowdbot.dsl.identity.population_inputs import population_inputs
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.round import Round

INDEX, LEADERBOARD = "index.html", "leaderboard.html"
#: Probability of a false verdict that leaderboards allow.
ALPHA = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Site:
    """The data from which a challenge's pages are made.

    Attributes:
        suite: name of the suite in commands, as the organiser gave it.
        expansion: the suite.
        tables: tables of the leaderboard.
        left_out: name of a bundle -> why it is left out.
        received: number of sealed planners in the log of the judge.
        log_hash: hash of the last line of that log; empty without a log.
    """

    suite: str
    expansion: Expansion
    tables: Sequence[Standings]
    left_out: Mapping[str, str] = field(default_factory=dict)
    lock: LockFiles
    received: int = 0
    log_hash: str = ""

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
    def few_crowds(self) -> str:
        """Return a warning if there are too few crowds to separate any ranks; usually empty."""
        scenarios = self.expansion.scenarios
        draws = len({s.id if s.crowd is None else population_inputs(s) for s in scenarios})
        least = least_draws(len(MAIN_SCORES), ALPHA)
        if draws >= least:
            return ""
        return (
            f"all planners will share one rank: {plural(draws, 'different crowd')}, and two "
            f"planners are told apart by {least} or more, three or four by a few more"
        )

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
    site = replace(site, tables=with_copies(site.tables, folder))
    copies = copy_suite(site.suite, site.expansion, site.lock, registry, folder)
    pictures = draw_conditions(site.expansion, registry, folder)
    replays = write_replays(site.entries, registry, folder)
    if site.entries:
        write_leaderboard(
            folder / LEADERBOARD, site.tables, site.left_out, f"{site.title}: leaderboard"
        )
    atomic_write(folder / INDEX, _index(site, copies, pictures, replays, registry))
    made = [INDEX, *copies, *(f for p in pictures for f in (p.file, p.small))]
    made += [r.file for r in replays] + [LEADERBOARD] * bool(site.entries)
    return [folder / name for name in made] + [entry.path for entry in site.entries]


def _index(
    site: Site,
    copies: Sequence[str],
    pictures: Sequence[Picture],
    replays: Sequence[SiteReplay],
    registry: Registry,
) -> str:
    metrics = registry.components("metric")
    return render_page(
        __package__,
        allowed=Allowed(images="'self'"),
        title=site.title,
        suite=site.suite_name,
        site=site,
        commands=take_part(site),
        pictures=pictures,
        replays=replays,
        opens=moment_text(site.round.opens or ""),
        closes=moment_text(site.round.closes or ""),
        copies=copies,
        scores=[
            (m.role, m.metric, without_symbol(metrics[m.metric].summary))
            for m in SHOWN
            if m.metric in metrics
        ],
        rules=RULES_TEXT,
        rules_number=RULES,
        leaderboard=LEADERBOARD if site.entries else "",
        version=metadata.version("crowdbot"),
    )


def moment_text(text: str) -> str:
    """Return a date or time of a round as readable text."""
    if not text:
        return ""
    found = datetime.fromisoformat(text)
    day = f"{found.day} {found:%B %Y}"
    if found.tzinfo is None:
        return f"{day}, in UTC"
    zone = f"UTC{found:%z}"
    return f"{day}, {found:%H:%M} {'UTC' if not found.utcoffset() else f'{zone[:-2]}:{zone[-2:]}'}"


def without_symbol(summary: str) -> str:
    """Return the summary of a metric without its symbol."""
    text = re.sub(r"^[A-Z]+(_\w+)?: ", "", summary)
    return text[:1].upper() + text[1:]


def take_part(site: Site) -> list[tuple[str, str]]:
    """Return the commands for participants, each with its purpose."""
    version = metadata.version("crowdbot")
    install = (
        "Install the crowdbot of this page; where pip does not find it, from its wheel.",
        f"pip install crowdbot=={version}",
    )
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
