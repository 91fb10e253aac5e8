"""The document format: a suite, or a single scenario, which is a suite of one.

::

    crowdbot: 1                 crowdbot: 1
    suite: {id: …, seed: …}     scenario: {id: …, environment: …, …}
    base: {…}
    matrix: {axis: {label: {override}}}
    only: {axis: [label, …]}    exclude: {axis: [label, …]}
    draws: N
    seeds: {crowd: [axis, …]}
    metrics: [name, …]
    record: all|used|none
    round: {opens: …, closes: …}
    references: {name: {override}}
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib import metadata
from pathlib import Path
from typing import cast, get_args

from crowdbot.dsl.checks.pydantic_errors import validate
from crowdbot.dsl.suite.commitment import read_commitment
from crowdbot.dsl.suite.documents import FORMAT, Recorded, ScenarioDocument, SuiteDocument
from crowdbot.dsl.suite.installed import Installed, check_metrics, check_versions
from crowdbot.dsl.suite.matrix import DRAW, Axis, read_axes
from crowdbot.dsl.suite.round import Round
from crowdbot.dsl.suite.selection import Kept, read_selection
from crowdbot.dsl.text.diagnostics import OTHER_FILES, Diagnostic, Mark
from crowdbot.dsl.text.finder import Finder
from crowdbot.dsl.text.nodes import Node, count, to_data
from crowdbot.errors import did_you_mean, nearest

MAX_REFERENCES = 16
MAX_FIELDS = 10_000_000

#: Fields of a scenario that are not allowed in documents.
_ELSEWHERE = {
    "id": "ids are made of the labels of the matrix",
    "references": "references stand beside 'base' or 'scenario'",
}


@dataclass(frozen=True, slots=True)
class ParsedSuite:
    """A document after parsing, before its scenarios are validated.

    Attributes:
        scenario_id: id of the only scenario of a document without axes; empty if it has none.
        seed: root seed with its position, or None for a single scenario.
        crowd_axes: names of the axes whose labels make the crowd's seed key.
        kept: labels of the selected combinations; None: all.
        commitment: commitment to the seed, or empty.
        hidden: True until the seed is revealed; then ``seed`` is a node of None.
        run_seeds: seeds of the runs that a bundle consists of.
        record: what to record by default; None: not given.
        round: round of a challenge; None: not given.
        files: path -> sha256 of files that a commitment covers.
        included: files that the document extends, and tables of agents.
        problems: errors found so far.
        tree: the whole document, including ``extends``.
        finder: finds the document's files; None: assets are not searched.
    """

    id: str
    title: str
    scenario_id: str
    seed: Node | None
    base: Node
    axes: tuple[Axis, ...]
    crowd_axes: tuple[str, ...]
    metrics: tuple[str, ...] | None
    references: dict[str, Node]
    problems: tuple[Diagnostic, ...]
    tree: Node
    kept: Kept | None = None
    finder: Finder | None = None
    commitment: str = ""
    hidden: bool = False
    run_seeds: tuple[int, ...] = (0,)
    record: Recorded | None = None
    round: Round | None = None
    files: Mapping[str, str] = field(default_factory=dict)
    included: tuple[Path, ...] = ()


def read_suite(
    root: Node, problems: list[Diagnostic], installed: Installed | None = None
) -> ParsedSuite | None:
    """Parse a document into its parts.

    Args:
        root: the merged tree of the whole document.
        problems: errors so far; more are added.
        installed: None leaves metrics and versions unchecked.

    Returns:
        None if the document is too broken to check its scenarios.
    """
    if not _right_version(root, problems):
        return None
    if root.child("suite") is None and root.child("scenario") is None:
        hint = "write 'suite:' and 'base:', or 'scenario:'"
        text = "the document is neither a suite nor a scenario"
        problems.append(Diagnostic("E013", text, root.mark, hint))
        return None
    model = ScenarioDocument if root.child("suite") is None else SuiteDocument
    read, found = validate(model, to_data(root), root)
    problems += found
    if installed is not None:
        check_metrics(root.child("metrics"), installed, problems)
        check_versions(root.child("kinds"), installed, problems)
    single = model is ScenarioDocument
    body = root.child("scenario" if single else "base")
    if body is None or not isinstance(body.value, dict):
        return None
    if single:
        return _scenario(root, body, problems)
    suite = _suite(root, body, problems)
    if not isinstance(read, SuiteDocument):
        return suite
    files = {one.path: one.sha256 for one in read.suite.files}
    return replace(suite, round=read.round, files=files)


def _scenario(root: Node, body: Node, problems: list[Diagnostic]) -> ParsedSuite:
    name, title = _text(body.child("id"), ""), _text(body.child("title"), "")
    _check_elsewhere(body, ("references",), problems)
    _check_references(root, problems)
    return ParsedSuite(
        name, title, name, None, body, (), (), _metrics(root), _references(root), tuple(problems),
        root, record=_record(root),
    )  # fmt: skip


def _suite(root: Node, body: Node, problems: list[Diagnostic]) -> ParsedSuite:
    head = root.child("suite")
    name = _text(head.child("id") if head else None, "suite")
    title = _text(head.child("title") if head else None, "")
    axes = read_axes(root.child("matrix"), problems, root.child("draws"))
    _check_elsewhere(body, ("id", "references"), problems)
    for axis in axes:
        for over in axis.labels.values():
            _check_elsewhere(over, ("id", "references"), problems)
    _check_references(root, problems)
    _check_own_id(head, problems)
    commitment, hidden = read_commitment(root, problems)
    seed = head.child("seed") if head else None
    if hidden or seed is None or not isinstance(seed.value, int):
        seed = Node(head.mark if head else root.mark, None if hidden else 0)
    crowd_axes = _crowd_axes(root, axes, problems)
    kept = read_selection(root, axes, problems)
    _check_size(root, body, axes, problems)
    run_seeds = _run_seeds(root, problems)
    return ParsedSuite(
        name, title, name, seed, body, axes, crowd_axes, _metrics(root), _references(root),
        tuple(problems), root, kept, None, commitment, hidden, run_seeds,
        _record(root),
    )  # fmt: skip


def _check_own_id(head: Node | None, problems: list[Diagnostic]) -> None:
    """Refuse two suites with the same id, which would share a folder of runs."""
    own = head.child("id") if head else None
    includer = own.mark.source.included_from if own else None
    if own is not None and includer is not None:
        text = f"the suite has no id of its own, only that of the included '{own.value}'"
        problems.append(Diagnostic("E212", text, includer, "add e.g. 'suite.id: my-suite'"))


def _right_version(root: Node, problems: list[Diagnostic]) -> bool:
    node = root.child("crowdbot")
    if node is None:
        text = "the document does not say which format it has"
        parts = {"extends", "environment"}
        ours = {*SuiteDocument.model_fields, *ScenarioDocument.model_fields, *parts}
        hint = f"start with 'crowdbot: {FORMAT}'" if ours & set(root.entries) else OTHER_FILES
        problems.append(Diagnostic("E012", text, root.mark, hint))
    elif type(node.value) is not int or node.value < 1:
        text = "the format version must be a whole number"
        problems.append(Diagnostic("E012", text, node.mark, f"write 'crowdbot: {FORMAT}'"))
    elif node.value > FORMAT:
        text = (
            f"format {node.value} needs crowdbot {node.value}.0 or newer; "
            f"this is {metadata.version('crowdbot')}, which reads format {FORMAT}"
        )
        hint = f"pip install 'crowdbot>={node.value}.0'"
        problems.append(Diagnostic("E012", text, node.mark, hint))
    else:
        return True
    return False


def _check_size(root: Node, body: Node, axes: tuple[Axis, ...], problems: list[Diagnostic]) -> None:
    """Refuse too many references or combinations, which even a small file can demand."""
    references = root.child("references")
    if references is not None and len(references.entries) > MAX_REFERENCES:
        text = f"the suite has {len(references.entries)} references; at most {MAX_REFERENCES}"
        problems.append(Diagnostic("E207", f"{text} are allowed", references.mark))
    combinations = math.prod(len(axis.labels) for axis in axes)
    if (fields := count(body)) * combinations > MAX_FIELDS:
        text = f"{combinations} combinations of {fields} fields are too many for one suite"
        problems.append(Diagnostic("E207", text, body.mark))


def _crowd_axes(root: Node, axes: tuple[Axis, ...], problems: list[Diagnostic]) -> tuple[str, ...]:
    """Return the axes of the seed key in the matrix's order; all axes by default."""
    known = [axis.name for axis in axes]
    seeds = root.child("seeds")
    listed = seeds.child("crowd") if seeds else None
    if listed is None or not isinstance(listed.value, tuple):
        return tuple(known)
    for item in listed.value:
        if isinstance(item.value, str) and item.value not in known:
            hint = did_you_mean(nearest(item.value, known)).removeprefix("; ")
            text = f"the matrix has no axis '{item.value}'"
            problems.append(Diagnostic("E208", text, item.mark, hint))
    names = {item.value for item in listed.value if isinstance(item.value, str)}
    return tuple(name for name in known if name in names or name == DRAW)


def _run_seeds(root: Node, problems: list[Diagnostic]) -> tuple[int, ...]:
    """Return the seeds of the runs that a bundle consists of; seed 0 by default."""
    seeds = root.child("seeds")
    listed = seeds.child("runs") if seeds else None
    if listed is None or not isinstance(listed.value, tuple):
        return (0,)
    found = tuple(i.value for i in listed.value if type(i.value) is int and i.value >= 0)
    if list(found) != sorted(set(found)):
        text = "the seeds of runs are not in rising order, each once"
        hint = f"write {sorted(set(found))}"
        problems.append(Diagnostic("E112", text, listed.mark, hint))
    return found or (0,)


def _check_elsewhere(body: Node, names: tuple[str, ...], problems: list[Diagnostic]) -> None:
    for name in names:
        if name in body.entries:
            mark: Mark = body.entries[name].key
            text = f"field '{name}' is not written here"
            problems.append(Diagnostic("E102", text, mark, _ELSEWHERE[name]))


def _check_references(root: Node, problems: list[Diagnostic]) -> None:
    """Check that references have names different from their scenario's id."""
    listed = root.child("references")
    for entry in (listed.entries if listed else {}).values():
        for name in {"id", "references"} & entry.node.entries.keys():
            text = f"a reference has no '{name}'"
            problems.append(Diagnostic("E102", text, entry.node.entries[name].key))


def _metrics(root: Node) -> tuple[str, ...] | None:
    listed = root.child("metrics")
    if listed is None or not isinstance(listed.value, tuple):
        return None
    return tuple(item.value for item in listed.value if isinstance(item.value, str))


def _record(root: Node) -> Recorded | None:
    found = root.child("record")
    value = None if found is None else found.value
    return cast("Recorded", value) if value in get_args(Recorded) else None


def _references(root: Node) -> dict[str, Node]:
    listed = root.child("references")
    found = {name: entry.node for name, entry in (listed.entries if listed else {}).items()}
    return {
        name: node if node.entries else replace(node, implied=True)
        for name, node in sorted(found.items())
        if isinstance(node.value, dict)
    }


def _text(node: Node | None, default: str) -> str:
    return node.value if node and isinstance(node.value, str) else default
