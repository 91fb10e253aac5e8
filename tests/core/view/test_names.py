from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.view.names import MapNames
from crowdbot.core.view.shapes import Text
from crowdbot.core.view.world import Map

WORLD = Map(x0=0.0, y0=0.0, x1=40.0, y1=20.0, scale=30.0, top=0.0)


def covered(text: Text) -> tuple[float, float, float, float]:
    """What a name covers at least, px: its small letters."""
    (x, y), length = text.at, 6.0 * len(text.text)
    if text.turned:
        return (x - 8.0, y - 0.5 * length, x, y + 0.5 * length)
    return (x, y - 8.0, x + length, y)


def overlap(one: Text, other: Text) -> bool:
    a, b = covered(one), covered(other)
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def box(x: float, y: float, wide: float, deep: float) -> list[tuple[float, float]]:
    return [(x, y), (x + wide, y), (x + wide, y + deep), (x, y + deep)]


areas = st.builds(
    box,
    st.integers(0, 20).map(float),
    st.integers(0, 10).map(float),
    st.sampled_from([2.0, 5.0, 15.0]),
    st.sampled_from([1.0, 4.0, 8.0]),
)


@given(st.lists(st.tuples(areas, st.sampled_from(["hall", "one destination"])), max_size=8))
def test_no_name_hides_another(listed: list[tuple[list[tuple[float, float]], str]]) -> None:
    names = MapNames(WORLD)
    put = [names.put(text, corners, "text-zone") for corners, text in listed]
    assert [t.text for t in put] == [text for _, text in listed]
    assert not any(overlap(a, b) for i, a in enumerate(put) for b in put[:i])


def test_one_area_of_two_streams_has_both_names_inside() -> None:
    names, corners = MapNames(WORLD), box(10.0, 5.0, 6.0, 4.0)
    first = names.put("one destination", corners, "text-route")
    second = names.put("two destination", corners, "text-route")
    (left, bottom), (right, top) = WORLD.at(10.0, 5.0), WORLD.at(16.0, 9.0)
    for text in (first, second):
        x0, y0, x1, y1 = covered(text)
        assert left < x0 < x1 < right
        assert top < y0 < y1 < bottom
    assert not overlap(first, second)


def test_names_of_narrow_areas_are_turned_beside_each_other() -> None:
    names, corners = MapNames(WORLD), box(1.0, 1.0, 2.0, 10.0)
    first = names.put("goal (goal)", corners, "text-goal")
    second = names.put("one destination", corners, "text-route")
    assert first.turned == second.turned == 90.0
    assert not overlap(first, second)
