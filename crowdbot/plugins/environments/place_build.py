"""Any environment whose spec says what its place is made of, as plain geometry."""

from __future__ import annotations

from crowdbot.plugin import EnvironmentParts, EnvironmentSpec, InputError, place_parts


def build(spec: EnvironmentSpec) -> EnvironmentParts:
    """The arrays of the place.

    Raises:
        InputError: the spec does not say what it is made of.
    """
    place = spec.place()
    if place is None:
        raise InputError(f"environment '{spec.kind}' does not say what it is made of")
    return place_parts(spec, place)
