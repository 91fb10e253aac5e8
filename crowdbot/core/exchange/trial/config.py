"""Config files and orders of trials: which trials there are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.exchange.companions import companion
from crowdbot.core.exchange.formats import Context
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.dsl.text.diagnostics import Mark

CONFIG = RowTable(
    "Config",
    (
        Row("experience/sourceFileExperiment", "suite", "the trials in the order of this file"),
        Row("experience@currentUser", "suite", "stands for {USER} and {TWO} in names of files"),
        Row("experience@startingTrial", "", "a suite has no scenario to begin with", unless="0"),
        Row("log", "", "crowdbot has its own messages"),
        Row("AddOns", "", "how a planner connects is an option of crowdbot serve"),
    ),
)


#: Most trials of one import.
_MOST = 500


@dataclass(slots=True)
class Trials:
    """Trial files without duplicates, and the values of variables in paths."""

    files: list[OpenedScene] = field(default_factory=list)
    words: dict[str, str] = field(default_factory=lambda: {"{USER}": "0", "{TWO}": "0"})

    def add(self, file: OpenedScene) -> None:
        """Add a trial unless it is there already."""
        if not self.has(file.path):
            self.files.append(file)

    def has(self, path: Path) -> bool:
        """Return True if a file is there."""
        return path.resolve() in {file.path.resolve() for file in self.files}


def find_trials(files: Sequence[OpenedScene], context: Context) -> Trials:
    """Return the trials among given files, and those that given config files refer to.

    Raises:
        SpecError: a named file is missing or is not what it should be.
    """
    trials = Trials()
    configs = [f for f in files if "Config" in f.tags]
    orders = [f for f in files if f.kind == "text"]
    for file in configs:
        for root in file.roots:
            named = _config(root, trials, context.report)
            if named is not None:
                path = companion(named, file.path, _replaced(named.text(), trials))
                if path.resolve() not in {f.path.resolve() for f in orders}:
                    orders.append(context.open(path))
    for file in orders:
        _order(file, trials, context)
    for file in files:
        if "Trial" in file.tags:
            trials.add(file)
    return trials


def _config(root: Item, trials: Trials, report: Report) -> Item | None:
    named = None
    experience = root.find("experience")
    if experience is not None:
        user = experience.find("@currentUser")
        if user is not None:
            number = user.whole(0)
            trials.words = {"{USER}": str(number), "{TWO}": str(number % 2)}
            report.interpreted(user, "suite", CONFIG.rows[1].note)
        start = experience.find("@startingTrial")
        if start is not None:
            if start.whole(0) == 0:
                report.carried(start, "suite")
            else:
                report.left_out(start, CONFIG.rows[2].note)
        named = experience.find("sourceFileExperiment")
        if named is not None:
            named.text()
            report.carried(named, "suite")
    for name, row in (("log", CONFIG.rows[3]), ("AddOns", CONFIG.rows[4])):
        if (item := root.find(name)) is not None:
            report.left_out(item, row.note)
    return named


def _order(file: OpenedScene, trials: Trials, context: Context) -> None:
    for number, line in enumerate(file.text.split("\n")):
        if not line.strip():
            continue
        item = Item("FileOrder", Mark(file.source, number, 0, max(1, len(line))), line)
        path: Path = companion(item, file.path, _replaced(line, trials))
        context.report.carried(item, "suite.matrix.trial")
        if trials.has(path):
            continue
        if len(trials.files) == _MOST:
            item.refuse(f"more than {_MOST} trials")
        trial = context.open(path)
        if "Trial" not in trial.tags:
            item.refuse(f"{path.name} is not a trial")
        trials.add(trial)


def _replaced(text: str, trials: Trials) -> str:
    for word, value in trials.words.items():
        text = text.replace(word, value)
    return text
