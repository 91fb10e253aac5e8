"""declare_metric: what is usual need not be said, and what is wrong is refused at once.

The ignored type errors are tests, too: mypy complains about an ignore that it does not need.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import fields
from typing import Any, Literal

import pytest

from crowdbot.dsl.spec.metric_invariants import InvariantOptions
from crowdbot.errors import PluginError
from crowdbot.plugin import MetricInvariants, MetricSpec, PositiveLength, declare_metric


class GapSpec(MetricSpec):
    """Least gap to anybody.

    Between surfaces.
    """

    kind: Literal["acme.gap"] = "acme.gap"
    limit: PositiveLength = 1.0


class TtcSpec(MetricSpec):
    """TTC at its least."""

    kind: Literal["acme.ttc"] = "acme.ttc"


class Undocumented(MetricSpec):
    kind: Literal["acme.odd"] = "acme.odd"


GAP = declare_metric(
    GapSpec, symbol="g", unit="m", better="higher", category="proximity", minimum=0.0
)


def declared(**changes: Any) -> Any:
    """A sound declaration, changed."""
    usual = {"spec": TtcSpec, "symbol": "t", "unit": "s", "better": "lower", "category": "c"}
    return declare_metric(**{**usual, **changes})


def test_what_follows_from_the_spec() -> None:
    assert (GAP.kind, GAP.category, GAP.score_category) == ("acme.gap", "metric", "proximity")
    assert GAP.build == f"{__name__}_build:Gap"
    assert GAP.summary == "g: least gap to anybody"
    assert list(GAP.variants) == ["corrected"]
    assert GAP.spec(limit=2.0).limit == 2.0
    assert declared().summary == "t: TTC at its least"
    bare = declared(spec=Undocumented)
    assert (bare.summary, bare.build) == ("t", f"{__name__}_build:Undocumented")
    assert declared(build="a:b", summary="s").summary == "s"


def test_variants_have_what_is_common_and_what_differs() -> None:
    metric = declare_metric(
        GapSpec,
        symbol="g",
        unit="m",
        better="higher",
        category="proximity",
        minimum=0.0,
        refinement="same",
        variants={
            "literal": {"refinement": "double", "better": "none"},
            "corrected": {},
            "share": {"unit": "1", "maximum": 1.0},
        },
    )
    found = {name: (v.unit, v.better, v.invariants) for name, v in metric.variants.items()}
    assert found == {
        "literal": ("m", "none", MetricInvariants(minimum=0.0, refinement="double")),
        "corrected": ("m", "higher", MetricInvariants(minimum=0.0, refinement="same")),
        "share": ("1", "higher", MetricInvariants(minimum=0.0, maximum=1.0, refinement="same")),
    }
    assert list(declared(variants=("b", "a")).variants) == ["b", "a"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"symbol": " "}, "metric TtcSpec: symbol is empty"),
        ({"category": ""}, "category is empty"),
        ({"unit": ""}, "unit of 'corrected' is empty"),
        ({"variants": {"a": {"unit": ""}}}, "unit of 'a' is empty"),
        ({"variants": ()}, "it has no variant"),
        ({"variants": "literal"}, "variants is 'literal', not a list of names"),
        ({"variants": ("a", "b", "a")}, "a variant is listed twice: a, b, a"),
        ({"better": "bigger"}, "better is 'bigger', not one of higher, lower, reference, none"),
        ({"variants": {"a": {"better": "more"}}}, "better is 'more'"),
        ({"variants": {"a": {"minimun": 0.0}}}, "'a' has no option 'minimun'; did you mean 'mini"),
        ({"least": 0.0}, "variant 'corrected' has no option 'least'"),
        ({"minimum": 1.0, "maximum": 0.0}, "'corrected': minimum 1.0 is not below maximum 0.0"),
        ({"changes_with": {"rotat": "why"}}, "no symmetry is called 'rotat'; did you mean 'rotat"),
    ],
)
def test_a_wrong_declaration_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(PluginError, match=message):
        declared(**changes)


def test_types_are_checked() -> None:
    with pytest.raises(PluginError):
        declare_metric(GapSpec, symbol="g", unit="m", better="bigger", category="c")  # type: ignore[arg-type]
    with pytest.raises(PluginError):
        declare_metric(GapSpec, symbol="g", unit="m", better="none", category="c", least=0.0)  # type: ignore[call-arg]
    with pytest.raises(PluginError):
        declare_metric(
            GapSpec,
            symbol="g",
            unit="m",
            better="none",
            category="c",
            variants={"a": {"better": "bigger"}},  # type: ignore[typeddict-item]
        )
    with pytest.raises(AttributeError):
        GAP.spec().limits  # type: ignore[attr-defined]  # noqa: B018


def test_every_invariant_can_be_declared() -> None:
    assert {f.name for f in fields(MetricInvariants)} == set(InvariantOptions.__annotations__)


def test_declaring_is_light() -> None:
    code = "import sys, crowdbot.dsl, crowdbot.plugins.metrics; print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
