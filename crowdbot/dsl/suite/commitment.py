"""Commit and reveal: a suite's seed is fixed before a deadline and revealed after it.

An organiser publishes ``suite.commitment``, the hash of a seed, a salt and the document, and
reveals ``suite.seed`` and ``suite.salt`` when tuning to them is no longer possible. Readers of the
revealed document can check them against the commitment. The salt prevents finding the seed by brute
force: there are at most 2**63 seeds, and small seeds are likely.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.dsl.text.nodes import Node, to_data

#: Format of a commitment, and of a salt with at least 128 bits.
COMMITMENT = r"^sha256:[0-9a-f]{64}$"
SALT = r"^[0-9a-f]{32,128}$"
#: Fewest different digits of a random salt: fewer have probability 4e-8 at 32 digits.
LEAST_DIGITS = 8

_FORMAT = 1
_SECRET = ("seed", "salt", "commitment")


def commitment_of(content: Any, seed: int, salt: str) -> str:
    """Return the commitment to a seed.

    Args:
        content: content of the document, from `committed_content`.
        seed: root seed of the crowd.
        salt: hexadecimal digits, from the system's entropy.
    """
    committed = {"commitment": _FORMAT, "document": content, "salt": salt, "seed": seed}
    text = json.dumps(committed, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return f"sha256:{hashlib.sha256(text.encode('ascii')).hexdigest()}"


def committed_content(root: Node) -> dict[str, Any]:
    """Return a document's content, including ``extends``, without seed, salt and commitment.

    Comments, order and distribution over files do not matter.
    """
    content: dict[str, Any] = to_data(root)
    head = content.get("suite")
    if isinstance(head, dict):
        content = {**content, "suite": {k: v for k, v in head.items() if k not in _SECRET}}
    return content


def is_random(salt: str) -> bool:
    """Return True if a salt looks random rather than chosen."""
    return len(set(salt)) >= LEAST_DIGITS


def read_commitment(root: Node, problems: list[Diagnostic]) -> tuple[str, bool]:
    """Return a document's commitment, or "", and True if its seed is still hidden.

    Args:
        root: the merged tree, whose fields have the right form.
        problems: errors so far; more are added.
    """
    head = root.child("suite")
    seed, salt, commitment = (head.child(name) if head else None for name in _SECRET)
    if commitment is None or not isinstance(commitment.value, str):
        if salt is not None:
            hint = "add 'suite.commitment', or remove the salt"
            problems.append(Diagnostic("E215", "a salt without a commitment", salt.mark, hint))
        return "", False
    if salt is None:
        _check_hidden(seed, commitment, problems)
        return commitment.value, True
    if seed is None:
        text = "a salt without the seed: draws are revealed by both"
        problems.append(Diagnostic("E215", text, salt.mark, "add 'suite.seed'"))
    elif isinstance(salt.value, str) and type(seed.value) is int:
        _check_revealed(root, (seed.value, seed.mark), (salt.value, salt.mark), problems)
    return commitment.value, False


def _check_hidden(seed: Node | None, commitment: Node, problems: list[Diagnostic]) -> None:
    """Refuse a visible seed with a commitment; an included suite's seed is not the hidden one."""
    own = commitment.mark.source.included_from is None
    if seed is None or (own and seed.mark.source.included_from is not None):
        return
    text = "a committed seed in the open, without its salt"
    hint = "remove it until 'crowdbot draws reveal' writes both"
    also = (("committed to at", commitment.mark),)
    problems.append(Diagnostic("E215", text, seed.mark, hint, also))


def _check_revealed(
    root: Node, seed: tuple[int, Mark], salt: tuple[str, Mark], problems: list[Diagnostic]
) -> None:
    head = root.child("suite")
    commitment = head.child("commitment") if head else None
    assert commitment is not None
    if not is_random(salt[0]):
        text = f"a salt of {len(set(salt[0]))} different digits: the seed could be found by trying"
        hint = "'crowdbot draws commit' makes a salt"
        problems.append(Diagnostic("E215", text, salt[1], hint))
    found = commitment_of(committed_content(root), seed[0], salt[0])
    if found == commitment.value:
        return
    text = "seed and salt are not those of the commitment, or the document was changed after it"
    hint = f"they give {found}"
    if commitment.mark.source.included_from is not None:
        hint = "of an included suite; remove it: 'suite: {commitment: null, salt: null, seed: …}'"
    also = (("seed at", seed[1]), ("salt at", salt[1]))
    problems.append(Diagnostic("E214", text, commitment.mark, hint, also))
