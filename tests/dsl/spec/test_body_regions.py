"""Body regions as words for the stiffness of a contact."""

from __future__ import annotations

import pytest
from pydantic import TypeAdapter, ValidationError

from crowdbot.dsl.scenario.scenario import Contact
from crowdbot.dsl.spec.body_regions import STIFFNESS


@pytest.mark.parametrize("region", STIFFNESS)
def test_a_region_is_its_stiffness(region: str) -> None:
    assert Contact(stiffness=region) == Contact(stiffness=STIFFNESS[region])  # type: ignore[arg-type]


def test_order_of_the_regions() -> None:
    """The skull is stiffest, the abdomen softest, legs stiffer than the trunk."""
    assert max(STIFFNESS, key=lambda r: STIFFNESS[r]) == "skull"
    assert min(STIFFNESS, key=lambda r: STIFFNESS[r]) == "abdomen"
    trunk = ("chest", "abdomen", "pelvis", "back")
    assert min(STIFFNESS["thigh"], STIFFNESS["lower_leg"]) > max(STIFFNESS[r] for r in trunk)


@pytest.mark.parametrize(("text", "value"), [("60 N/mm", 60e3), (5e4, 5e4), ("30 kN/m", 3e4)])
def test_numbers_stay_numbers(text: object, value: float) -> None:
    assert Contact(stiffness=text).stiffness == value  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["leg", "lower leg", "", "0 N/m", -1.0, None, ["chest"]])
def test_other_words_are_refused(text: object) -> None:
    with pytest.raises(ValidationError):
        Contact(stiffness=text)  # type: ignore[arg-type]


def test_editors_know_the_words() -> None:
    schema = TypeAdapter(Contact).json_schema(mode="validation")
    assert "lower_leg" in str(schema["properties"]["stiffness"])


def test_a_typing_error_is_told_the_nearest_region() -> None:
    with pytest.raises(
        ValidationError, match=r"'lower_legs' is neither a quantity of stiffness .*lower_leg"
    ) as caught:
        Contact(stiffness="lower_legs")  # type: ignore[arg-type]
    assert caught.value.errors()[0]["ctx"]["hint"] == "did you mean 'lower_leg'?"
