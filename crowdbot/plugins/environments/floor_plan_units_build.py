"""Check that the numbers of a vector plan fit its unit: metres, degrees, feet."""

from __future__ import annotations

import logging
import math
import re
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import Array, InputError
from crowdbot.plugins.environments.floor_plan_fields import FloorPlanFields

_LOG = logging.getLogger(__name__)
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
#: Mean radius of the earth, m.
_EARTH = 6_371_008.8
#: Names of reference systems whose numbers are longitude and latitude: OGC CRS84, EPSG 4326 and
#: 4979, all WGS 84.
_IN_DEGREES = re.compile(r"CRS:?84|EPSG:+[\d.]*:?(4326|4979)\b|WGS[ _]?(19)?84$", re.IGNORECASE)
#: Web Mercator, whose metres hold at the equator; the radius of its sphere, m.
_MERCATOR = re.compile(r"EPSG:+[\d.]*:?(3857|900913|3785)\b|ESRI:+(102100|102113)\b", re.IGNORECASE)
_MERCATOR_RADIUS, _STRETCHED = 6_378_137.0, 1.01
#: Smallest plan, m, and largest plan in degrees, which is 100 km.
_LEAST, _MOST_DEGREES = 1.0, 1.0
#: Largest distance of a plan from the world's origin, m; a plan farther away was not moved there.
_FAR = 1e5


def declared_crs(content: Any) -> str:
    """Return the reference system that a GeoJSON file names, or "".

    The member ``crs`` is from GeoJSON 2008; RFC 7946 dropped it, but programs still write it.
    """
    crs = content.get("crs") if isinstance(content, dict) else None
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    return name if isinstance(name, str) else ""


def check_numbers(
    shapes: list[Any], spec: FloorPlanFields, name: str, crs: str, stated: bool
) -> None:
    """Check that the coordinates fit the unit.

    Args:
        shapes: as read from the file.
        name: the file's name.
        crs: from `declared_crs`.
        stated: True if the document gives the unit.

    Raises:
        InputError: degrees are read as lengths, or lengths as degrees; or metres are stretched.
    """
    numbers = shapely.get_coordinates(shapes)
    if not (len(numbers) and np.isfinite(numbers).all()):
        return
    low, high = numbers.min(axis=0), numbers.max(axis=0)
    wide = float((high - low).max())
    where = f"its numbers reach from {_at(low)} to {_at(high)}"
    if spec.unit == "deg":
        worst = numbers[np.argmax(np.max(np.abs(numbers) / (180.0, 90.0), axis=1))]
        if abs(worst[0]) > 180.0 or abs(worst[1]) > 90.0:
            raise InputError(
                f"{name}: {_at(worst)} is not a longitude and latitude, and unit is 'deg'; "
                f"{where}: see 'unit'"
            )
        return
    _check_mercator(crs, 0.5 * (low[1] + high[1]), name)
    on_earth = _on_earth(low, high)
    small = 0.0 < wide <= _MOST_DEGREES and wide * UNITS[spec.unit] < _LEAST
    if small and on_earth:
        degrees = f" (the file names {crs})" if _in_degrees(crs) else ""
        east, north = (high - low) * _metres_a_degree(float(0.5 * (low[1] + high[1])))
        middle = 0.5 * (low + high)
        raise InputError(
            f"{name}: {where}, {wide * UNITS[spec.unit]:.3g} m as {spec.unit}, but "
            f"{east:.3g} m × {north:.3g} m as longitude and latitude{degrees}: write "
            f"'unit: deg' and 'origin: [{middle[0]:.6f}, {middle[1]:.6f}]'"
        )
    if _in_degrees(crs) and not stated and (wide > _MOST_DEGREES or not on_earth):
        _LOG.warning(
            "%s: the file says that its numbers are degrees (%s), but %s, which would be %.0f km: "
            "they count as %s; write 'unit' to say so",
            *(name, crs, where, 111.2 * wide, spec.unit),
        )


def _check_mercator(crs: str, north: float, name: str) -> None:
    """Refuse numbers of Web Mercator far from the equator, which are not metres.

    Raises:
        InputError: they are stretched by more than a hundredth.
    """
    stretched = math.cosh(north / _MERCATOR_RADIUS) if _MERCATOR.search(crs) else 1.0
    if stretched > _STRETCHED:
        raise InputError(
            f"{name}: the file names {crs} (Web Mercator), in which a metre is {stretched:.2f} "
            "long there: export it as longitude and latitude, with 'unit: deg', or in a national "
            "grid"
        )


def check_place(shapes: list[Any], spec: FloorPlanFields, name: str) -> None:
    """Check that a plan lies near the world's origin.

    Args:
        shapes: world frame, m.

    Raises:
        InputError: it is too far away to be intended.
    """
    if not shapes:
        return
    x0, y0, x1, y1 = shapely.total_bounds(shapes).tolist()
    x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    if math.hypot(x, y) <= _FAR:
        return
    if spec.unit == "deg":
        point = np.array(spec.origin) + _turned(
            np.array([x, y]), -spec.rotation
        ) / _metres_a_degree(spec.origin[1])
        origin = f"[{point[0]:.6f}, {point[1]:.6f}]"
    else:
        origin = f"[{spec.origin[0] - x:.10g} m, {spec.origin[1] - y:.10g} m]"
    raise InputError(
        f"{name}: the plan lies around ({x:.10g}, {y:.10g}) m, {math.hypot(x, y) / 1000.0:.0f} km "
        f"from the world's (0, 0); with 'origin: {origin}' it lies around (0, 0)"
    )


def in_metres(shape: Any, spec: FloorPlanFields, name: str) -> Any:
    """Return a geometry in the world frame, m.

    Raises:
        InputError: a coordinate is not finite.
    """
    if not np.all(np.isfinite(shapely.get_coordinates(shape))):
        raise InputError(f"{name}: a coordinate is not finite")
    if spec.unit != "deg":
        scale = UNITS[spec.unit]
        return shapely.transform(shape, lambda points: moved(scale * points, spec))
    scales = _metres_a_degree(spec.origin[1])
    return shapely.transform(
        shape, lambda points: _turned((points - spec.origin) * scales, spec.rotation)
    )


def moved(points: Array, spec: FloorPlanFields) -> Array:
    """Return points (N, 2) of a plan in the world frame, m."""
    found: Array = _turned(points, spec.rotation) + np.array(spec.origin)
    return found


def _turned(points: Array, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    turned: Array = points @ np.array([[c, s], [-s, c]])
    return turned


def _metres_a_degree(latitude: float) -> Array:
    """Return metres per degree of longitude and of latitude."""
    north = math.radians(1.0) * _EARTH
    return np.array([north * math.cos(math.radians(latitude)), north])


def _on_earth(low: Array, high: Array) -> bool:
    most = np.maximum(np.abs(low), np.abs(high))
    return bool(most[0] <= 180.0 and most[1] <= 90.0)


def _in_degrees(crs: str) -> bool:
    return _IN_DEGREES.search(crs) is not None


def _at(point: Array) -> str:
    return f"({point[0]:.10g}, {point[1]:.10g})"
