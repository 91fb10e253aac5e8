"""Every metric has a card; what the card says is checked by the conformance kit."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.errors import PluginError
from crowdbot.plugin import Component, MetricSpec
from tests.paths import ROOT

CARDS = ROOT / "docs/reference/metrics"
KINDS = sorted(discover(allow=(), entry_points=False).components("metric"))

PLUGIN = """
from typing import Literal
from crowdbot.plugin import MetricSpec, declare_metric
from crowdbot.plugin import hookimpl

class HeightSpec(MetricSpec):
    '''Height.'''

    kind: Literal["acme_cards.height"] = "acme_cards.height"

@hookimpl
def crowdbot_components():
    more = dict(category="x"{card})
    return {{"metric": [declare_metric(HeightSpec, symbol="h", unit="m", better="none", **more)]}}
"""


@pytest.fixture(autouse=True)
def _forget() -> Iterator[None]:
    yield
    sys.modules.pop("acme_cards", None)


def acme(folder: Path, card: str = "", *, package: bool = True) -> Path:
    path = folder / "acme_cards"
    if package:
        path.mkdir()
        file = path / "__init__.py"
    else:
        path = file = folder / "acme_cards.py"
    file.write_text(PLUGIN.format(card=card), encoding="utf-8")
    return path


def found(path: Path) -> Component[MetricSpec]:
    registry = discover(extra=[path], allow=(), entry_points=False)
    errors = [p.error for p in registry.plugins if p.error]
    if errors:
        raise PluginError(errors[0])
    return registry.find("metric", "acme_cards.height")


def test_every_metric_has_a_page_and_every_page_a_metric() -> None:
    pages = {p.stem for p in CARDS.glob("*.md")}
    assert pages == set(KINDS)


def test_the_package_holds_the_pages() -> None:
    registry = discover(allow=(), entry_points=False)
    for kind in KINDS:
        page = (CARDS / f"{kind}.md").read_text(encoding="utf-8")
        assert registry.find("metric", kind).read_card() == page


def test_a_metric_without_a_card_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PluginError, match=r"has no card; .*acme_cards:cards/height\.md"):
        found(acme(tmp_path))


def test_a_card_lies_beside_the_spec(tmp_path: Path) -> None:
    path = acme(tmp_path)
    (path / "cards").mkdir()
    (path / "cards/height.md").write_text("# acme_cards.height\n", encoding="utf-8")
    assert found(path).read_card() == "# acme_cards.height\n"


def test_a_card_may_be_elsewhere_or_text(tmp_path: Path) -> None:
    path = acme(tmp_path, card=', card="acme_cards:docs.md"')
    (path / "docs.md").write_bytes(b"\xff\xfe")
    with pytest.raises(PluginError, match="cannot be read"):
        found(path).read_card()
    sys.modules.pop("acme_cards")
    (tmp_path / "file").mkdir()
    single = acme(tmp_path / "file", card=', card="# acme_cards.height\\n"', package=False)
    assert found(single).read_card() == "# acme_cards.height\n"


@pytest.mark.parametrize("card", ["acme_cards:none.md", "no_such_package:x.md", "nonsense"])
def test_a_card_that_is_not_there(card: str, tmp_path: Path) -> None:
    with pytest.raises(PluginError, match="has no card"):
        found(acme(tmp_path, card=f', card="{card}"'))


def test_a_file_without_package_needs_a_card_as_text(tmp_path: Path) -> None:
    with pytest.raises(PluginError, match="has no card"):
        found(acme(tmp_path, package=False))
