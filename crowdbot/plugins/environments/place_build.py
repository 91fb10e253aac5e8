"""Build any environment whose spec gives its place."""

from __future__ import annotations

from crowdbot.plugin import EnvironmentParts, EnvironmentSpec, InputError, place_parts


def build(spec: EnvironmentSpec) -> EnvironmentParts:
    """Return the arrays of the place.

    Raises:
        InputError: the spec gives no place.
    """
    place = spec.place()
    if place is None:
        raise InputError(f"environment '{spec.kind}' does not say what it is made of")
    return place_parts(spec, place)
