"""WKT as written by people and databases: several geometries, comments, quotes, measures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.plugin import InputError
from crowdbot.plugin.for_environments import DEEPEST

_CURVE = re.compile(r"(COMPOUND|MULTI)?CURVE(POLYGON)?|CIRCULARSTRING|MULTISURFACE", re.IGNORECASE)
_SRID = re.compile(r"\s*SRID\s*=\s*\d+\s*;", re.IGNORECASE)


def geometry_of(text: str, name: str) -> Any:
    """Return the geometry in a WKT text; a collection if there are several.

    Args:
        text: without a byte order mark.
        name: the file's name, for messages.

    Raises:
        InputError: it is something else, or has curves.
    """
    curve = _CURVE.search(text)
    if curve:
        raise InputError(
            f"{name}: {curve[0].upper()}: curves are not read; replace them by lines "
            "(ST_CurveToLine in PostGIS)"
        )
    _check_depth(text, name)
    texts = list(_parts_of_wkt(text)) or [text]
    parts = [_without_measures(_one_of_wkt(part, name)) for part in texts]
    return parts[0] if len(parts) == 1 else shapely.GeometryCollection(parts)


def _parts_of_wkt(text: str) -> Iterator[str]:
    """Yield the geometries of a text: each begins at a line's start, where all brackets are closed.

    Lines that begin with ``#`` are comments; databases write quotes around, and semicolons after.
    """
    part, depth = "", 0
    for line in text.splitlines():
        if line.lstrip().startswith("#"):
            continue
        part, depth = f"{part}\n{line}", depth + line.count("(") - line.count(")")
        words = part.strip().upper()
        if depth <= 0 and (words.endswith((")", ";", '"', "'")) or words.endswith("EMPTY")):
            yield part
            part, depth = "", 0
    if part.strip():
        yield part


def _one_of_wkt(part: str, name: str) -> Any:
    try:
        with np.errstate(invalid="ignore"):  # NaN is reported separately
            return shapely.from_wkt(_SRID.sub("", part.strip().strip("\"';").strip(), count=1))
    except shapely.errors.ShapelyError as error:
        raise InputError(f"{name}: is not well-known text: {error}") from error


def _without_measures(shape: Any) -> Any:
    """Return a geometry without the measures (M)."""
    if not getattr(shapely, "has_m", lambda _: False)(shape):
        return shape
    if not shapely.has_z(shape):
        return shapely.force_2d(shape)
    return shapely.from_wkb(shapely.to_wkb(shape, output_dimension=3))


def _check_depth(text: str, name: str) -> None:
    """Refuse geometries that are nested deeper than the library's stack allows."""
    depth = 0
    for found in re.finditer(r"[()]", text):
        depth += 1 if found[0] == "(" else -1
        if depth > DEEPEST:
            line = text.count("\n", 0, found.start()) + 1
            column = found.start() - text.rfind("\n", 0, found.start())
            raise InputError(
                f"{name}: line {line}, column {column}: nested deeper than {DEEPEST} brackets"
            )
