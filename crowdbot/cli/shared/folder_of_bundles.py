"""Options and reading that the commands about a folder of bundles share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import option
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.bundle.standings import Standings
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.suite.expansion import Expansion

Accept = Annotated[
    list[str] | None, option("NAME", "Compare although bundles differ in this; repeatable.")
]
Keys = Annotated[
    list[str] | None,
    option("HEX", "Accept outcomes of verify that this public key signed; repeatable."),
]


@dataclass(frozen=True, slots=True, kw_only=True)
class FolderOfBundles:
    """The tables of a folder's bundles; ``left_out``: name of a bundle -> reason."""

    tables: Sequence[Standings]
    left_out: Mapping[str, str]


def trusted_keys(keys: Sequence[str]) -> set[str]:
    """Return the trusted public keys: those given, and the user's own.

    Raises:
        InputError: one is not a public key.
    """
    from crowdbot.core.bundle.signature import check_public_key, own_public_key

    return {check_public_key(text) for text in keys} | {own_public_key()} - {""}


def read_bundles(
    folder: Path,
    registry: Registry,
    by: str,
    *,
    accept: Sequence[str] = (),
    keys: Sequence[str] = (),
    audits: Sequence[Path] = (),
    suites: Sequence[Expansion] = (),
) -> FolderOfBundles:
    """Return the tables of a folder; print why bundles or verification records are left out.

    Args:
        folder: folder of the bundles.
        registry: the installed components.
        by: what decides the order: a metric, or the ranking rule.
        accept: differences that are accepted.
        keys: public keys of organisers, besides the user's own.
        audits: audits of suites; default: those of the folder.
        suites: the organisers' suites: only their bundles are kept, and their rounds decide which
            are accepted; none: bundles of every suite.

    Raises:
        InputError: there is no bundle, or none of these suites.
    """
    from crowdbot.core.bundle.entries import load_entries
    from crowdbot.core.bundle.standings import set_apart, standings
    from crowdbot.core.scoring.score_scale import score_scales
    from crowdbot.core.statistics.audit import AUDIT, read_audit

    trusted = trusted_keys(keys)
    entries, left_out = load_entries(folder, registry, trusted)
    for entry in entries:
        if entry.doubt:
            say(f"warning: {entry.doubt}", err=True)
    rounds = {suite.suite_id: suite.round for suite in suites}
    chosen = [e for e in entries if not rounds or e.manifest.edition.suite in rounds]
    names = ", ".join(rounds)
    if entries and not chosen:
        raise InputError(f"{folder}: no bundle of {names} there")
    left_out |= {e.path.name: f"it is not of {names}" for e in entries if e not in chosen}
    if rounds:
        chosen = [e.in_round(rounds[e.manifest.edition.suite]) for e in chosen]
    kept, apart = set_apart(chosen, accept)
    left_out = dict(sorted((left_out | apart).items()))
    for name, why in left_out.items():
        say(f"warning: {name} is left out: {why}", err=True)
    read = [read_audit(path) for path in audits or sorted(folder.glob(f"*{AUDIT}"))]
    return FolderOfBundles(
        tables=standings(kept, by, accept, read, score_scales(registry)), left_out=left_out
    )
