"""A metric's card, which explains its numbers, compared with the code.

The format is fixed, so that cards can be checked: a table of two columns, then the sections of
`SECTIONS`; those of variants and parameters begin with a table. What a metric does not have may be
left out: parameters, a literal form, references, an effect of sampling.
"""

from __future__ import annotations

import doctest
import io
import re
from collections.abc import Iterator, Mapping
from typing import Any

import crowdbot.testing.degenerate as degenerate
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.metric_component import MetricComponent
from crowdbot.testing.scored import metric_of, scores_of

SECTIONS = (
    "Formula",
    "Variants",
    "Parameters",
    "Failure modes",
    "What the literal form gets wrong",
    "Worked example",
    "Source",
)
#: Combination of runs, if it is not the mean of their scores.
OPTIONAL = "Many runs"
#: Rows of the table at the top; `MAY_LACK` are those for "none".
HEAD = ("symbol", "category", "unit", "better", "range", "sampling", "needs")
MAY_LACK = ("sampling", "needs")


def check_card_says_what_the_scores_say(component: Component[Any]) -> None:
    """The card has all sections, with the code's symbol, unit, direction, variants and parameters.

    If this fails, correct the card; ``docs/reference/metrics/risk.md`` shows the form.
    """
    metric, text = metric_of(component), component.read_card()
    title = text.splitlines()[0]
    assert title == f"# {component.kind}", f"the card is called '{title}'"
    sections = re.findall(r"^## (.+)$", text, re.MULTILINE)
    _assert_names("sections", sections, (*SECTIONS, OPTIONAL), (*_without(metric), OPTIONAL))
    head = {name: value for name, value in rows(text.partition("\n## ")[0]) if name}
    _assert_names("rows of the table at the head", list(head), HEAD, MAY_LACK)
    declared = {
        "symbol": metric.symbol,
        "category": metric.score_category,
        "unit": metric.unit,
        "better": metric.better,
    }
    for name, text_of_it in declared.items():
        assert head[name] == text_of_it, f"{name}: '{head[name]}', declared is '{text_of_it}'"
    assert all(head.values()), "an empty cell in the table at the head"
    _assert_variants(metric, dict(_named(section(text, "Variants"))))
    _assert_parameters(component, dict(_named(section(text, "Parameters"))))
    for name in sections:
        assert section(text, name).strip(), f"section '{name}' is empty"
    _assert_reasons(component, text)


def check_card_examples_run(component: Component[Any]) -> None:
    """The card's worked example is a doctest and passes.

    If this fails, correct the example, or find the change that affects the numbers.
    """
    text = re.sub(r"^```.*$", "", section(component.read_card(), "Worked example"), flags=re.M)
    test = doctest.DocTestParser().get_doctest(text, {}, component.kind, "card", 0)
    assert any(e.want for e in test.examples), "the card shows no result of '>>>'"
    output = io.StringIO()
    doctest.DocTestRunner(verbose=False).run(test, out=output.write)
    assert not output.getvalue(), output.getvalue()


def section(text: str, name: str) -> str:
    """Return the text after a heading, up to the next."""
    return text.partition(f"\n## {name}\n")[2].partition("\n## ")[0]


def rows(text: str) -> Iterator[list[str]]:
    """Yield the rows of all tables in a text, without rulers; a bar after a backslash is text."""
    for line in text.splitlines():
        if line.startswith("|") and not re.fullmatch(r"[|\- :]+", line):
            cells = re.split(r"(?<!\\)\|", line)[1:-1]
            yield [cell.strip().replace("\\|", "|") for cell in cells]


def _named(text: str) -> Iterator[tuple[str, list[str]]]:
    """Yield name and further cells of the rows whose first cell is code in backticks."""
    for name, *cells in rows(text):
        if re.fullmatch(r"`[^`]+`", name):
            yield name.strip("`"), cells


def _without(metric: MetricComponent[Any]) -> Iterator[str]:
    """Yield the sections that the card of this metric may leave out."""
    if "literal" not in metric.variants:
        yield "What the literal form gets wrong"
    if set(metric.spec.model_fields) <= {"kind"}:
        yield "Parameters"


def _assert_names(
    subject: str, found: list[str], known: tuple[str, ...], may_lack: tuple[str, ...]
) -> None:
    """Check that all known names were found, in order; those in ``may_lack`` may be missing."""
    expected = [n for n in known if n in found or n not in may_lack]
    in_order = [n for n in found if n != OPTIONAL] == [n for n in expected if n != OPTIONAL]
    assert in_order, f"{subject} are {', '.join(found)}; expected are {', '.join(expected)}"


def _assert_variants(metric: MetricComponent[Any], table: Mapping[str, list[str]]) -> None:
    declared = {name: [v.unit, v.better] for name, v in metric.variants.items()}
    found = {name: cells[:2] for name, cells in table.items()}
    assert found == declared, f"variants, unit and better: {found}, declared are {declared}"


def _assert_parameters(component: Component[Any], table: Mapping[str, list[str]]) -> None:
    fields = {n: f for n, f in component.spec.model_fields.items() if n != "kind"}
    assert set(table) == set(fields), (
        f"parameters are {', '.join(fields) or 'none'}; the card has {', '.join(table) or 'none'}"
    )
    for name, (default, *_) in table.items():
        value = fields[name].get_default()
        number = float(value) if isinstance(value, int | float) else None
        stated = re.match(r"[-+0-9.e]+", default)
        if number is not None and not isinstance(value, bool):
            assert stated, f"parameter {name}: '{default}' is not a number"
            close = abs(float(stated[0]) - number) <= 1e-4 * abs(number)
            assert close, f"parameter {name}: default is {number:g}, the card says {default}"
        else:
            assert str(value).lower() in default.lower(), f"parameter {name}: default is {value}"


def _assert_reasons(component: Component[Any], text: str) -> None:
    modes = section(text, "Failure modes")
    for name, world in degenerate.worlds().items():
        for one in scores_of(component, world).values():
            assert not one.reason or f"`{one.reason}`" in modes, (
                f"{name}: '{one.reason}' is not a failure mode of the card"
            )
            for extra in one.extras:
                assert f"`{extra}`" in text, f"the card does not explain the extra '{extra}'"
