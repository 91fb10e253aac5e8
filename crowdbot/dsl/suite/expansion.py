"""Scenarios of a document, with what they were expanded from."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.axis_words import AxisWords
from crowdbot.dsl.suite.documents import Recorded
from crowdbot.dsl.suite.round import Round
from crowdbot.dsl.suite.suite_entry import NO_SUITE, SuiteEntry
from crowdbot.dsl.text.nodes import Node


@dataclass(frozen=True)
class Expansion:
    """The contents of a document.

    Attributes:
        suite_id: id of the suite; of the scenario in a document with only one.
        metrics: names or patterns of the metrics to score; None means all.
        trees: id -> the merged tree of the scenario, which knows the position of each value; not
            compared, since scenarios hold the same values.
        axes: id -> axis -> label, in the suite's order; no axes in a document without a matrix.
        commitment: commitment to the suite's seed, or empty. While the seed is hidden, the
            scenarios are marked; a revealed seed has been checked.
        run_seeds: seeds of the runs that a bundle consists of.
        words: axis -> label -> readable names of the quantity and the value.
        altered: the ``key=value`` texts that ``--set`` applied to each scenario.
        record: what to record by default; None: not given.
        round: round of a challenge; None: not given.
    """

    suite_id: str
    title: str
    scenarios: list[Scenario]
    metrics: tuple[str, ...] | None = None
    trees: dict[str, Node] = field(default_factory=dict, repr=False, compare=False)
    axes: dict[str, dict[str, str]] = field(default_factory=dict, repr=False)
    commitment: str = ""
    run_seeds: tuple[int, ...] = (0,)
    words: dict[str, dict[str, AxisWords]] = field(default_factory=dict, repr=False)
    altered: tuple[str, ...] = ()
    record: Recorded | None = None
    round: Round | None = None

    def words_of(self, scenario: str) -> dict[str, AxisWords]:
        """Return axis -> readable names of a scenario's label; axes without names are left out."""
        labels = self.axes.get(scenario, {})
        return {a: self.words[a][x] for a, x in labels.items() if x in self.words.get(a, {})}

    @cached_property
    def _positions(self) -> dict[str, int]:
        return {scenario.id: i for i, scenario in enumerate(self.scenarios)}

    @property
    def single(self) -> bool:
        """Return True if the document is a single scenario without a matrix."""
        ids = [s.id.partition("+")[0] for s in self.scenarios]
        return ids == [self.suite_id]

    @property
    def suite(self) -> str:
        """Return the suite's name in records; all documents with a single scenario share one."""
        return NO_SUITE if self.single else self.suite_id

    def entry(self, scenario: Scenario) -> SuiteEntry:
        """Return a scenario's position and labels in this suite."""
        return SuiteEntry(
            suite=self.suite,
            axes=self.axes.get(scenario.id, {}),
            words=self.words_of(scenario.id),
            position=self._positions[scenario.id],
            altered=self.altered,
        )
