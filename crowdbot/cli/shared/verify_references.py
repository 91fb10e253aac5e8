"""Repeats a sample of reference scores for `crowdbot verify`."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry

#: The word for the file that comes with crowdbot.
_WORD = "references"
_FINE = ("identical", "different_platform")


def verify_references(
    text: str, registry: Registry, size: int | None, seed: int | None
) -> dict[str, Any] | None:
    """Repeat a sample of the reference scores' runs; None if the argument names a bundle instead.

    Args:
        text: the argument of `verify`.
        registry: the installed components.
        size: number of runs; None: all.
        seed: seed of the sample; None: random.

    Raises:
        InputError: it is a damaged file of reference scores.
    """
    from crowdbot.core.results.reference_file import SHIPPED, open_references

    named = SHIPPED if text == _WORD else text
    if named != SHIPPED and not named.endswith(".json.xz"):
        return None
    found = open_references(named)
    assert found is not None  # since it is one of both
    from crowdbot.cli.shared.one_run import import_simulate, interruptible
    from crowdbot.cli.shared.progress import show_progress
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    import_simulate()
    from crowdbot.core.campaign.remake import RemakeSetup, remake, sample_of

    seed = secrets.randbelow(2**32) if seed is None else seed
    with stdout_to_stderr(), interruptible() as stop, show_progress() as progress:
        setup = RemakeSetup(registry=registry, progress=progress, stop=stop)
        chosen = sample_of(found.results.runs, size, seed)
        runs = {run.directory: remake(setup, run) for run in chosen}
    fine = all(relation in _FINE for relation in runs.values())
    return {"references": text, "seed": seed, "ok": fine, "runs": runs}


def outcome_lines(document: dict[str, Any]) -> Iterator[str]:
    """Yield a line for each repeated run, and one with the number of identical runs."""
    for name, relation in document["runs"].items():
        yield f"{name}: {relation}"
    count = len(document["runs"])
    same = sum(r == "identical" for r in document["runs"].values())
    yield (
        f"references: {same} of {count} runs are the same, bit by bit, "
        f"sample seed {document['seed']}"
    )
