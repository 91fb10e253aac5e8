"""Commit and reveal: a suite's seed that is fixed before a deadline, and known after it.

An organiser publishes ``suite.commitment``, the hash of a seed, a salt and the document, and
reveals ``suite.seed`` and ``suite.salt`` when nobody can tune to them any more. Whoever reads the
revealed document checks that they are what was committed to. The salt keeps the seed from being
found by trying: seeds are few, 2**63 at most, and people like small ones.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.dsl.text.nodes import Node, to_data

#: Form of a commitment, and of a salt of at least 128 bits.
COMMITMENT = r"^sha256:[0-9a-f]{64}$"
SALT = r"^[0-9a-f]{32,128}$"
#: A random salt has hardly ever fewer different digits: chance 4e-8 at 32 digits.
LEAST_DIGITS = 8

_FORMAT = 1
_SECRET = ("seed", "salt", "commitment")


def commitment_of(content: Any, seed: int, salt: str) -> str:
    """The commitment to a seed.

    Args:
        content: of the document, from `committed_content`.
        seed: root of the crowd's random numbers.
        salt: hexadecimal digits, from the system's entropy.
    """
    committed = {"commitment": _FORMAT, "document": content, "salt": salt, "seed": seed}
    text = json.dumps(committed, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return f"sha256:{hashlib.sha256(text.encode('ascii')).hexdigest()}"


def committed_content(root: Node) -> dict[str, Any]:
    """What a document says, all it extends included, without seed, salt and commitment.

    Comments, order and the files it is spread over do not count.
    """
    content: dict[str, Any] = to_data(root)
    head = content.get("suite")
    if isinstance(head, dict):
        content = {**content, "suite": {k: v for k, v in head.items() if k not in _SECRET}}
    return content


def is_random(salt: str) -> bool:
    """Whether a salt looks as if nobody had chosen it."""
    return len(set(salt)) >= LEAST_DIGITS


def read_commitment(root: Node, problems: list[Diagnostic]) -> tuple[str, bool]:
    """The commitment of a document, or "", and whether its seed is hidden still.

    Args:
        root: the merged tree; the form of its fields has been checked.
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
    """A seed in the open commits to nothing; that of an included suite is not the hidden one."""
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
