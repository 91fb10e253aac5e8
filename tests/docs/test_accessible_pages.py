"""What axe-core finds in pages of the theme is mended, and stays so when it is done twice."""

from __future__ import annotations

import pytest

from scripts.accessible_pages import mended

MADE = {
    '<p class="caption" role="heading">Tutorial</p>': 'aria-level="2">Tutorial',
    '<aside class="sidebar-drawer">': 'aria-label="All pages"',
    '<aside class="toc-drawer">': 'aria-label="On this page"',
    '<div class="table-wrapper docutils container">': '<div tabindex="0" class="table-wrapper',
    "<pre>x</pre>": '<pre tabindex="0">x',
    '<tr><th class="head"><p></p></th><th class="head">a</th></tr>': '<td></td><th class="head">a',
    '<div id="search-results"></div>': '<h1>Search</h1>\n<div id="search-results">',
}


@pytest.mark.parametrize(("made", "wanted"), MADE.items())
def test_pages_are_mended_once(made: str, wanted: str) -> None:
    page = mended(made)
    assert wanted in page
    assert mended(page) == page


def test_a_page_with_a_heading_keeps_it() -> None:
    page = '<h1>Results</h1><div id="search-results">'
    assert mended(page) == page
