"""Unknown parts in every element and map of a file: each is named in the report, at its place."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from crowdbot.core.exchange.report import Report
from crowdbot.errors import InputError, SpecError
from tests.core.exchange.importing import FILES, imported

_ELEMENT = re.compile(r"<([A-Za-z]\w*)((?:\s+[\w:]+=\"[^\"]*\")*)\s*(/?)>")
#: Maps whose keys are names of the file's own: another key would be another place or person.
_OWN = {"exits", "distributions", "checkpoints", "shape", "controlLaw", "controlSim"}


def _elements(text: str) -> str:
    """Return XML with an attribute and a child ``odd0``, ``odd1`` … in each element."""
    count = iter(range(10_000))

    def more(found: re.Match[str]) -> str:
        name, attributes, empty = found.groups()
        inside = "" if name in _OWN else f'<odd{next(count)} a="1"/>'
        end = f"</{name}>" if empty else ""
        return f'<{name}{attributes} odd{next(count)}="1">{inside}{end}'

    return _ELEMENT.sub(more, re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL))


def _maps(data: Any, count: Iterator[int], name: str = "") -> Any:
    """Return plain data with a key ``odd0``, ``odd1`` … in each map."""
    if isinstance(data, list):
        return [_maps(entry, count, name) for entry in data]
    if not isinstance(data, dict):
        return data
    whole = {key: _maps(value, count, key) for key, value in data.items()}
    return whole if name in _OWN else {**whole, f"odd{next(count)}": 1}


def _places(report: Report) -> dict[str, tuple[int, int]]:
    """Line and column, from 0, of each part that is named as left out, by its own name."""
    found = {}
    for entry in report.entries:
        for path, mark in [(entry.theirs, entry.at), *entry.within]:
            if mark is not None and entry.outcome.value == "left out":
                found[re.split("[/@]", path)[-1]] = (mark.line, mark.column)
    return found


def _all_named(file: Path, text: str, *beside: Path) -> None:
    file.write_text(text)
    places, lines = _places(imported(file, *beside).report), text.split("\n")
    odd = re.findall(r"\bodd\d+(?==| a=|\":|:)", text)
    assert len(odd) > 5
    assert not [name for name in odd if name not in places]
    assert not [name for name in odd if name not in lines[places[name][0]]]


@pytest.mark.parametrize(
    "name", ["agents.xml", "policies.xml", "pedsim.xml", "commonroad.xml", "robot_sf.svg",
             "trials/small.xml"],
)  # fmt: skip
def test_in_each_element(tmp_path: Path, name: str) -> None:
    text = (FILES / name).read_text(encoding="utf-8-sig")
    _all_named(tmp_path / Path(name).name, _elements(text))


@pytest.mark.parametrize("name", ["hunav.yaml", "vadere.scenario", "jupedsim.json"])
def test_in_each_map(tmp_path: Path, name: str) -> None:
    data = _maps(yaml.safe_load((FILES / name).read_text()), iter(range(10_000)))
    beside = [FILES / "floor.wkt"] if name == "jupedsim.json" else []
    _all_named(tmp_path / name, json.dumps(data, indent=1), *beside)


def test_in_a_recording(tmp_path: Path) -> None:
    """Each column, a person of one line, and a cell without a column."""
    file = tmp_path / "walk.csv"
    head, rows = "time,id,x,y,yaw,mood\n", "0,1,0,0,0,a\n1,1,1,0,0,b\n"
    file.write_text(head + rows + "1,2,5,5,0,c\n")
    report = imported(file).report
    assert notes_of(report)["CSV with a header/mood"] == "no meaning of it is known here"
    assert "follow" in notes_of(report)["CSV with a header/yaw"]
    assert _places(report)["mood"] == (0, 16)
    assert _places(report)["person 2"] == (3, 0)
    file.write_text(head + rows.replace(",b", ",b,more"))
    with pytest.raises(InputError, match=r"walk.csv:3: 7 cells, and the first row has 6"):
        imported(file)


def notes_of(report: Report) -> dict[str, str]:
    """The reasons of what was left out, by what it concerns."""
    return {e.theirs: e.note for e in report.entries if e.outcome.value == "left out"}


def test_a_document_that_would_be_too_large_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("crowdbot.core.exchange.checked.MAX_BYTES", 500)
    with pytest.raises(SpecError, match=r"agents.xml:1:1: .*give fewer files in one command"):
        imported("agents.xml")
