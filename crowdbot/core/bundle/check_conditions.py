"""Check the conditions of a run against the scenario that lies beside it in the bundle."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.check_run import ClaimedRun
from crowdbot.core.runs import run_directory as files
from crowdbot.dsl.text.plain_document import parse_document
from crowdbot.errors import InputError

#: How crowdbot writes the rates of a scenario: on one line.
_RATES = re.compile(r"^  rates: \{([^{}\n]*)\}$", re.MULTILINE)
_RATE = re.compile(r"([a-z_]+): ([0-9.e+-]+)")
#: Prefix of the conditions that are rates.
_PREFIX = "rates."


def condition_problems(archive: Archive, run: ClaimedRun) -> Iterator[str]:
    """Yield differences between the conditions in a record and those of its scenario.

    Raises:
        InputError: the scenario cannot be read.
    """
    name = f"{run.entry.directory}/{files.SCENARIO}"
    rates = _rates(archive.text(name), name)
    claimed = {k: v for k, v in run.record.conditions.items() if k.startswith(_PREFIX)}
    for key in sorted(claimed):
        if claimed[key] != rates.get(key):
            yield f"{key} is {claimed[key][:40]} in {files.RECORD}, and " \
                  f"{rates.get(key)} in {files.SCENARIO}"  # fmt: skip


def _rates(text: str, name: str) -> dict[str, str]:
    lines = _RATES.findall(text)
    found: Mapping[str, Any]
    if len(lines) == 1:
        found = {key: float(value) for key, value in _RATE.findall(lines[0])}
    else:
        document = parse_document(text, name)
        scenario = document.get("scenario") if isinstance(document, dict) else None
        found = scenario.get("rates", {}) if isinstance(scenario, dict) else {}
    if not isinstance(found, Mapping) or not all(
        isinstance(v, int | float) for v in found.values()
    ):
        raise InputError(f"{name}: its rates are not numbers")
    return {f"{_PREFIX}{key}": f"{value:g} Hz" for key, value in found.items()}
