"""Expand the combinations of a document, and check each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Any

from crowdbot.dsl.checks.between_fields import Checks
from crowdbot.dsl.checks.pydantic_errors import locate, validate
from crowdbot.dsl.checks.validation_cache import ValidParts
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.asset_files import AssetFiles
from crowdbot.dsl.suite.axis_words import axis_words
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.matrix import DRAW, combinations
from crowdbot.dsl.suite.overrides import parse_overrides
from crowdbot.dsl.suite.suite import ParsedSuite
from crowdbot.dsl.suite.suite_entry import digest_of
from crowdbot.dsl.text.diagnostics import MAX_ERRORS, Diagnostic, Mark
from crowdbot.dsl.text.merge import Merged, merge, nest
from crowdbot.dsl.text.nodes import Entry, Node, to_data
from crowdbot.dsl.text.path_names import path_problem
from crowdbot.errors import SpecError

#: Largest number of scenario errors before the rest of a suite is skipped.
_ENOUGH = 50_000


@dataclass
class _SharedError:
    """An error, and the scenarios that have it."""

    diagnostic: Diagnostic
    ids: list[str]
    reference: str


@dataclass(frozen=True, slots=True)
class _Combination:
    """A combination of the matrix: id, key of the crowd seed, labels per axis, and document."""

    name: str
    key: str
    labels: dict[str, str]
    tree: Node

    @property
    def draw(self) -> str:
        """Return the label of the crowd draw; empty if there is only one."""
        return self.labels.get(DRAW, "")


class Expander:
    """One expansion: caches of shared parts, and the errors so far."""

    def __init__(self, suite: ParsedSuite, model: type[Scenario], overrides: Sequence[str]) -> None:
        self._suite, self._model = suite, model
        self._errors: dict[tuple[str, Mark, str], _SharedError] = {}
        self._problems = list(suite.problems)
        self._set = parse_overrides(overrides, self._problems)
        self._altered = tuple(overrides)
        self._suffix = "+" + digest_of(overrides) if overrides else ""
        self._set_in: dict[int, Node] = {}
        self._merged: Merged = {}
        self._data: dict[Node, Any] = {}
        self._seeds: dict[str, Node] = {}
        self._folders: dict[str, str] = {}
        self._parts, self._checks = ValidParts(), Checks()
        self._assets = AssetFiles(suite.finder, suite.files) if suite.finder else None
        self._validated: dict[tuple[tuple[str, int], ...], Scenario] = {}
        self._bare: list[_Combination] | None = None
        self._total = self._noted = 0

    def run(self) -> Expansion:
        """Return all scenarios.

        Raises:
            SpecError: with the errors of all scenarios, without duplicates.
        """
        scenarios, trees, axes = [], {}, {}
        for bare in self._trees():
            if self._noted > _ENOUGH:
                break
            tree = self._complete(bare)
            scenario = self._scenario(bare, tree)
            if scenario is not None:
                scenarios.append(scenario)
                trees[bare.name] = tree
                axes[bare.name] = bare.labels
        self._raise_problems()
        suite = self._suite
        return Expansion(
            suite.id,
            suite.title,
            scenarios,
            suite.metrics,
            trees,
            axes,
            suite.commitment,
            suite.run_seeds,
            axis_words(suite.base, suite.axes, self._set),
            self._altered,
            suite.record,
            suite.round,
        )

    def _unusable(self, bare: _Combination) -> str:
        """Return why a combination's id cannot be a folder name beside earlier ones, or ""."""
        if bare.name == self._suite.scenario_id:
            return ""
        first = self._folders.setdefault(bare.name.lower(), bare.name)
        if first != bare.name:
            return f"'{bare.name}' is '{first}' where file systems do not tell capitals"
        return path_problem(bare.name)

    def _longest(self, bare: _Combination) -> Mark:
        """Return the position of a combination's longest label."""
        keys = {axis.name: axis.keys for axis in self._suite.axes}
        marks = [
            (len(label), keys[axis][label])
            for axis, label in bare.labels.items()
            if label in keys[axis]
        ]
        return max(marks, key=itemgetter(0), default=(0, self._suite.base.mark))[1]

    def one(self, index: int) -> Scenario:
        """Return one scenario.

        Raises:
            SpecError: with the errors of the scenarios expanded so far.
        """
        if self._bare is None:
            self._bare = list(self._trees())
        scenario = self._scenario(self._bare[index], self._complete(self._bare[index]))
        self._raise_problems()
        assert scenario is not None
        return scenario

    def _scenario(self, bare: _Combination, tree: Node) -> Scenario | None:
        """Return a combination with its references.

        None if there was an error, which is recorded.
        """
        self._total += 1
        if why := self._unusable(bare):
            self._note(Diagnostic("E116", f"the id {why}", self._longest(bare)), bare.name, "")
            return None
        scenario = self._validate(bare.name, tree)
        references = {
            reference: self._validate(bare.name, self._complete(bare, over), reference)
            for reference, over in self._suite.references.items()
        }
        return scenario and scenario.model_copy(update={"references": references})

    def _raise_problems(self) -> None:
        if problems := [*self._problems, *self._folded()]:
            raise SpecError(sorted_problems(problems))

    def _trees(self) -> Iterator[_Combination]:
        """Yield the selected combinations as trees."""
        suite, axes = self._suite, [axis.name for axis in self._suite.axes]
        for combination in combinations(suite.base, suite.axes):
            if suite.kept is not None and combination.labels not in suite.kept:
                continue
            labels = dict(zip(axes, combination.labels, strict=True))
            key = "-".join(labels[axis] for axis in suite.crowd_axes)
            name = "-".join(v for axis, v in labels.items() if axis != DRAW)
            name = name or suite.scenario_id
            draw = labels.get(DRAW)
            name = f"{name}-{draw}" if name and draw else name
            yield _Combination(name and name + self._suffix, key, labels, combination.tree)

    def _complete(self, bare: _Combination, reference: Node | None = None) -> Node:
        """Return a combination merged with the reference, ``--set`` and the seed, in this order."""
        tree = bare.tree
        if reference is None:
            tree = merge(tree, self._set, self._merged)
        else:
            tree = merge(tree, reference, self._merged)
            tree = merge(tree, self._set_below(reference), self._merged)
        return self._with_seed(tree, bare.key, bare.draw)

    def _set_below(self, reference: Node) -> Node:
        """Return the ``--set`` changes that apply to a reference, cached per reference."""
        if id(reference) not in self._set_in:
            self._set_in[id(reference)] = _unless_removed(self._set, reference)
        return self._set_in[id(reference)]

    def _with_seed(self, tree: Node, key: str, draw: str) -> Node:
        """Write the seed's root and key into a suite's crowd, below the document's own values.

        Each draw has different people, even if the document sets the key.
        """
        crowd = tree.entries.get("crowd")
        if self._suite.seed is None or crowd is None or not crowd.node.entries:
            return tree
        if key not in self._seeds:
            mark = self._suite.seed.mark
            parts = {"root": self._suite.seed, "key": Node(mark, key)}
            if self._suite.hidden:
                del parts["root"]
            seed = Node(mark, {k: Entry(mark, node) for k, node in parts.items()}, implied=True)
            self._seeds[key] = nest(("seed",), seed, mark)
        node = merge(self._seeds[key], crowd.node, self._merged)
        own = locate(crowd.node, ("seed", "key"))
        if draw and not own.rest and isinstance(own.node.value, str):
            joined = replace(own.node, value=f"{own.node.value}-{draw}".lstrip("-"))
            node = merge(node, nest(("seed", "key"), joined, joined.mark))
        return replace(tree, value={**tree.entries, "crowd": replace(crowd, node=node)})

    def _validate(self, name: str, tree: Node, reference: str = "") -> Scenario | None:
        """Validate a tree; equal trees are validated once."""
        data = to_data(tree, self._data)  # keeps the nodes alive, so that their ids stay unique
        shared = tuple((key, id(entry.node)) for key, entry in sorted(tree.entries.items()))
        if known := self._validated.get(shared):
            return known.model_copy(update={"id": name})
        if name:
            data = {**data, "id": name}
        scenario, found = self._with_assets(tree, data)
        if scenario is not None and not found:
            self._parts.add(tree, scenario)
            found = self._checks.of(scenario, tree)
        for diagnostic in found:
            self._note(diagnostic, name, reference)
        if found or scenario is None:
            return None
        if self._is_hidden(tree):
            scenario.hide(self._suite.commitment)
        self._validated[shared] = scenario
        return scenario

    def _is_hidden(self, tree: Node) -> bool:
        """Return True if people are sampled from the suite's hidden seed."""
        crowd = tree.child("crowd")
        if not self._suite.hidden or crowd is None or not crowd.entries:
            return False
        return bool(locate(crowd, ("seed", "root")).rest)

    def _with_assets(
        self, tree: Node, data: dict[str, Any]
    ) -> tuple[Scenario | None, list[Diagnostic]]:
        """Return the validated scenario with its files found, and the errors."""
        scenario, diagnostics = self._with_known_parts(tree, data), list[Diagnostic]()
        if scenario is None:
            scenario, diagnostics = validate(self._model, data, tree)
        if scenario is None or self._assets is None:
            return scenario, diagnostics
        filled = self._assets.fill(scenario, tree, data, diagnostics)
        if filled is not data and not diagnostics:
            scenario, diagnostics = validate(self._model, filled, tree)
        return scenario, diagnostics

    def _with_known_parts(self, tree: Node, data: dict[str, Any]) -> Scenario | None:
        """Return the scenario built from validated parts; None if that fails."""
        try:
            return self._model.model_validate(self._parts.fill(tree, data))
        except (Exception, SystemExit):  # validators may not expect validated parts
            return None

    def _note(self, diagnostic: Diagnostic, name: str, reference: str) -> None:
        self._noted += 1
        key = (diagnostic.code, diagnostic.mark, diagnostic.message)
        folded = self._errors.setdefault(key, _SharedError(diagnostic, [], reference))
        if not folded.ids or folded.ids[-1] != name:
            folded.ids.append(name)

    def _folded(self) -> Iterator[Diagnostic]:
        for folded in self._errors.values():
            notes = [folded.diagnostic.hint] if folded.diagnostic.hint else []
            if folded.reference:
                notes.append(f"in reference '{folded.reference}'")
            if len(folded.ids) < self._total:
                of = f"the first {self._total}" if self._noted > _ENOUGH else str(self._total)
                notes.append(f"in {len(folded.ids)} of {of} combinations, first: {folded.ids[0]}")
            yield replace(folded.diagnostic, hint="; ".join(notes).replace("?; ", "? "))


def _unless_removed(change: Node, reference: Node) -> Node:
    """Return a change without the entries for parts that a reference removes."""
    entries = {}
    for key, entry in change.entries.items():
        over = reference.child(key)
        if over is None:
            entries[key] = entry
        elif over.entries and entry.node.entries:
            entries[key] = replace(entry, node=_unless_removed(entry.node, over))
        elif over.value is not None and over.value != {}:
            entries[key] = entry
    return replace(change, value=entries, implied=change.implied or not entries)


def sorted_problems(problems: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the first problems by place, each once."""
    return sorted(dict.fromkeys(problems), key=Diagnostic.sort_key)[:MAX_ERRORS]
