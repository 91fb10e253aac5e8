"""Compare imported maps with their images, for ``crowdbot validate --against-image``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from crowdbot.cli.output.say import say, say_json
from crowdbot.errors import SpecError

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.spec.component_specs import Agreement
    from crowdbot.dsl.text.diagnostics import Diagnostic


def check_against_images(
    specs: Sequence[str], registry: Registry, overrides: Sequence[str] = (), *, as_json: bool
) -> int:
    """Print how the occupancy grids of documents agree with the floor made of them.

    Args:
        specs: files, or names of packaged suites, that are valid.
        overrides: ``KEY=VALUE`` for every scenario.

    Returns:
        The exit code: 1 if a cell's centre is floor in one of both only.

    Raises:
        SpecError: documents are not valid; the others were compared and printed.
        UnknownNameError: there is no such suite.
    """
    found: list[tuple[str, str, Agreement]] = []
    wrong: list[Diagnostic] = []
    for spec in specs:
        try:
            found += [(spec, *one) for one in _agreements(spec, registry, overrides)]
        except SpecError as error:
            wrong += error.diagnostics
    if as_json:
        listed = [{"spec": spec, "scenario": name, **one._asdict()} for spec, name, one in found]
        say_json(listed)
    elif found or not wrong:
        say("\n".join(_line(*row) for row in found) or "no occupancy grid in it")
    if wrong:
        raise SpecError(wrong)
    return 1 if any(one.wrong for *_, one in found) else 0


def _agreements(
    spec: str, registry: Registry, overrides: Sequence[str]
) -> Iterator[tuple[str, Agreement]]:
    """Yield, for each place made from an image, its first scenario's id and the comparison."""
    from crowdbot.core.scenarios.library import open_suite

    seen = set[str]()
    expansion, _ = open_suite(spec, registry, overrides)
    for scenario in expansion.scenarios:
        place = scenario.environment.model_dump_json(exclude={"zones", "portals"})
        if place not in seen:
            seen.add(place)
            one = scenario.environment.against_image()
            if one is not None:
                yield scenario.id, one


def _line(spec: str, scenario: str, one: Agreement) -> str:
    at = ", ".join(f"({x:.2f}, {y:.2f})" for x, y in one.where)
    text = f"{spec}: {scenario}: {one.image}: {one.cells} cells, {one.wrong} differ"
    text += f", around {at}" if at else ""
    return text + (f"; {one.left_out} left out" if one.left_out else "")
