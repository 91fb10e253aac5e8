"""Files that are broken, foreign or hostile end as errors with a place, in bounded memory."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import pytest

from crowdbot.core.exchange.source import LARGEST
from crowdbot.core.exchange.xml_items import MOST_DEEP
from crowdbot.errors import SpecError
from tests.core.exchange.importing import FILES, imported

_LAUGHS = '<!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>\n<Trial>&b;</Trial>'
_OUTSIDE = '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]>\n<Trial>&a;</Trial>'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (_LAUGHS, "document type"),
        (_OUTSIDE, "document type"),
        ("<a>" * (MOST_DEEP + 1) + "</a>" * (MOST_DEEP + 1), "nested deeper"),
        ("", "not XML: no element found"),
        ("<Trial><scene></Trial>", "not XML: mismatched tag"),
        ("<Trial/>" * 9, "more than 8 root elements"),
        ("<html><body/></html>", "no known format"),
        ("<Trial/>", "as imported"),
        ("<Trial>\xff", "not XML"),
        ("<!--" * 20_000, "not XML"),
    ],
)
def test_hostile_xml_is_refused_at_its_place(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "file.xml"
    file.write_text(text)
    if text == "<Trial/>":
        assert imported(file).ids  # empty, but a trial: somebody is added
        return
    with pytest.raises(SpecError) as caught:
        imported(file)
    assert f"{file}:" in str(caught.value)
    assert message in str(caught.value)


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    file = tmp_path / "large.xml"
    with file.open("wb") as stream:
        stream.truncate(LARGEST + 1)
    with pytest.raises(SpecError, match="larger than 32 MB"):
        imported(file)


def test_many_odd_comments_on_one_line_take_linear_time(tmp_path: Path) -> None:
    file = tmp_path / "long.xml"
    file.write_text(f"<Agents>{'<!-- -- -->' * 30_000}<Agent\trad='1'/></Agents>")
    with pytest.raises(SpecError, match="an Agent without pos"):
        imported(file)


def test_orders_of_too_many_trials_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("<Trial/>")
    order = tmp_path / "FileOrder.csv"
    order.write_text("a.xml\n" * 3000)
    assert imported(order).ids == ["a"]
    order.write_text("missing.xml\n")
    with pytest.raises(SpecError, match=r"FileOrder.csv:1:1: .* not beside"):
        imported(order)


def test_a_file_that_is_named_is_looked_for_beside_the_one_that_names_it(tmp_path: Path) -> None:
    file = tmp_path / "world.xml"
    for name in ("../../etc/passwd", "/etc/passwd"):
        file.write_text(f'<Simulation><Agents file="{name}"/></Simulation>')
        with pytest.raises(SpecError, match=r"world.xml:1:\d+"):
            imported(file)


_Mutation = Callable[[random.Random, str], str]


def _cut(rng: random.Random, text: str) -> str:
    at = rng.randrange(len(text))
    return text[:at] + text[at + rng.randrange(1, 40) :]


def _swap(rng: random.Random, text: str) -> str:
    at = rng.randrange(len(text))
    return text[:at] + rng.choice("<>&\"'/=-09.eE\x00\u202e\n \u00e9") + text[at + 1 :]


def _value(rng: random.Random, text: str) -> str:
    starts = [i for i, c in enumerate(text) if c == '"']
    at = rng.choice(starts[:-1])
    end = text.index('"', at + 1)
    values = ("", "-1", "1e400", "nan", "1e308", "0", "true", "x" * 500, "-0", "99999999999")
    return text[: at + 1] + rng.choice(values) + text[end:]


def _line(rng: random.Random, text: str) -> str:
    lines = text.split("\n")
    at, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    if rng.random() < 0.5:
        del lines[at]
    else:
        lines.insert(other, lines[at])
    return "\n".join(lines)


MUTATIONS: tuple[_Mutation, ...] = (_cut, _swap, _value, _line)


def fails_well(file: Path, beside: tuple[Path, ...] = ()) -> bool:
    """Import a file; return True if it is refused, with a place in each message."""
    try:
        imported(file, *beside)
    except SpecError as error:
        for one in error.diagnostics:
            assert one.mark.source.name.startswith(str(file.parent)), str(one)
        return True
    return False


@pytest.mark.parametrize("name", ["trials/every.xml", "agents.xml", "policies.xml", "world.xml"])
def test_mutated_files_never_end_in_a_traceback(tmp_path: Path, name: str) -> None:
    text = (FILES / name).read_text(encoding="utf-8-sig")
    for other in ("agents.xml", "policies.xml", "trials/walk3.csv"):
        (tmp_path / Path(other).name).write_text((FILES / other).read_text())
    (tmp_path / "walk0.csv").write_text((FILES / "trials" / "walk3.csv").read_text())
    rng, refused = random.Random(name), 0
    for number in range(6):
        file = tmp_path / f"mutated{number}.xml"
        file.write_text(rng.choice(MUTATIONS)(rng, text), encoding="utf-8")
        refused += fails_well(file)
    assert refused


@pytest.mark.parametrize(
    ("name", "text", "hint"),
    [
        ("scene.xml", "<Experiment version='2.0'/>", "Menge's XML is not read: export its floor"),
        ("geo.xml", "<geometry version='0.8'/>", "XML of JuPedSim before 1.0 is not read"),
        (
            "arena.json",
            '{"robots": [], "resets": 5, "map": "a"}',
            "Arena-Rosnav's JSON is not read",
        ),
        ("a.world", 'floorplan (bitmap "maze.png")', "a map.yaml that names its bitmap is"),
        ("a.osm", "<osm version='0.6'/>", "{kind: floor_plan, file: plan.wkt}"),
        ("a.ifc", "ISO-10303-21;", "IFC is not read"),
        ("a.csv", "1,2,3,4,5,6,7,8,9\n", "as recorded people it cannot be read"),
        ("r.urdf", "<robot name='r'/>", "robots.robot.model: {kind: urdf, file: r.urdf}"),
        ("map.yaml", "{image: m.pgm, occupied_thresh: 0.6}", "{kind: floor_plan, file: map.yaml}"),
    ],
)
def test_other_files_are_refused_with_what_to_do(
    tmp_path: Path, name: str, text: str, hint: str
) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(SpecError, match="E403") as caught:
        imported(tmp_path / name)
    assert hint in caught.value.diagnostics[0].hint
