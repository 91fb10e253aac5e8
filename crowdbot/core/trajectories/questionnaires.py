"""Questionnaires of one drive: read answers of NASA-TLX and USE.

The metrics report invalid answers as a reason, so that one wrong form does not stop an evaluation.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crowdbot.core.support.arguments import path_of
from crowdbot.core.support.text_files import input_text
from crowdbot.errors import InputError, UnknownNameError

#: Scales of the NASA task load index; a low rating of performance is good.
TLX_SCALES = (
    "mental_demand",
    "physical_demand",
    "temporal_demand",
    "performance",
    "effort",
    "frustration",
)
#: Dimensions of the USE questionnaire, and their numbers of items.
USE_ITEMS = {"usefulness": 8, "ease_of_use": 11, "ease_of_learning": 4, "satisfaction": 7}

_COLUMNS = ("questionnaire", "item", "value")

#: None: not applicable, or not answered.
Answer = float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Questionnaires:
    """Answers; empty if there are none.

    Attributes:
        tlx_ratings: scale -> 0..100.
        tlx_weights: scale -> number of times chosen in the 15 pairwise comparisons, 0..5.
        use: dimension -> its items, 1..7.
    """

    tlx_ratings: Mapping[str, Answer] = field(default_factory=dict)
    tlx_weights: Mapping[str, Answer] = field(default_factory=dict)
    use: Mapping[str, Sequence[Answer]] = field(default_factory=dict)

    @classmethod
    def from_mapping(cls, data: Mapping[str, object]) -> Questionnaires:
        """Build from plain data.

        ``{"nasa_tlx": {"mental_demand": 60, ..., "weights": {"mental_demand": 5, ...}},
        "use": {"usefulness": [7, 6, None, ...], ...}}``. Ratings may also stand under
        ``"ratings"``; ratings and weights may be six numbers in the order of `TLX_SCALES`.

        Raises:
            InputError: not a mapping, or not a number.
            UnknownNameError: no such questionnaire, scale or dimension.
        """
        _check_known("questionnaire", _mapping("questionnaires", data), ("nasa_tlx", "use"))
        tlx = dict(_mapping("nasa_tlx", data.get("nasa_tlx") or {}))
        weights = tlx.pop("weights", None)
        ratings = tlx.pop("ratings", tlx)
        use = _mapping("use", data.get("use") or {})
        _check_known("dimension of use", use, USE_ITEMS)
        return cls(
            tlx_ratings=_scales("ratings", ratings),
            tlx_weights=_scales("weights", weights or {}),
            use={name: tuple(_answer(name, a) for a in _row(name, use[name])) for name in use},
        )

    @classmethod
    def from_csv(cls, path: Path | str) -> Questionnaires:
        """Read a table with the columns questionnaire, item, value; an empty value means no answer.

        ``nasa_tlx`` has the items of `TLX_SCALES`, and ``weight_`` before them; ``use`` has
        ``usefulness_1`` to ``usefulness_8`` and so on for `USE_ITEMS`.

        Raises:
            InputError: it cannot be read, or a row is wrong (the message names the line).
        """
        path = path_of("path", path)
        try:
            with io.StringIO(input_text(path), newline="") as file:
                reader = csv.DictReader(file, strict=True)
                if not set(_COLUMNS) <= set(reader.fieldnames or ()):
                    raise InputError(f"{path}:1: expected the columns {','.join(_COLUMNS)}")
                cells: dict[tuple[str, str], Answer] = {}
                for row in reader:
                    _add_cell(cells, f"{path}:{reader.line_num}", row)
        except csv.Error as error:
            raise InputError(f"{path}: not a table: {error}") from error
        return cls._from_cells(cells)

    @classmethod
    def _from_cells(cls, cells: Mapping[tuple[str, str], Answer]) -> Questionnaires:
        tlx = {item: v for (sheet, item), v in cells.items() if sheet == "nasa_tlx"}
        items = {item for sheet, item in cells if sheet == "use"}
        return cls(
            tlx_ratings={s: tlx[s] for s in TLX_SCALES if s in tlx},
            tlx_weights={s: tlx[f"weight_{s}"] for s in TLX_SCALES if f"weight_{s}" in tlx},
            use={
                name: tuple(cells.get(("use", f"{name}_{i}")) for i in range(1, count + 1))
                for name, count in USE_ITEMS.items()
                if any(f"{name}_{i}" in items for i in range(1, count + 1))
            },
        )


_ITEMS = {
    "nasa_tlx": {*TLX_SCALES, *(f"weight_{s}" for s in TLX_SCALES)},
    "use": {f"{name}_{i}" for name, count in USE_ITEMS.items() for i in range(1, count + 1)},
}


def _add_cell(cells: dict[tuple[str, str], Answer], place: str, row: Mapping[str, Any]) -> None:
    sheet, item, text = (str(row[c] or "").strip() for c in _COLUMNS)
    try:
        _check_known("questionnaire", (sheet,), _ITEMS)
        _check_known(f"item of {sheet}", (item,), _ITEMS[sheet])
        value = _answer(item, float(text)) if text else None
    except (ValueError, InputError) as error:
        raise InputError(f"{place}: {error}") from error
    if (sheet, item) in cells:
        raise InputError(f"{place}: {item} was answered before")
    cells[sheet, item] = value


def _check_known(category: str, names: Any, known: Any) -> None:
    for name in names:
        if name not in known:
            raise UnknownNameError(category, str(name), known)


def _mapping(name: str, data: Any) -> Mapping[str, Any]:
    if not isinstance(data, Mapping):
        raise InputError(f"questionnaires: {name} must map names to answers")
    return data


def _row(name: str, data: Any) -> Sequence[Any]:
    if isinstance(data, str) or not hasattr(data, "__len__") or isinstance(data, Mapping):
        raise InputError(f"questionnaires: {name} must be a row of answers")
    return list(data)


def _scales(category: str, data: Any) -> dict[str, Answer]:
    if not isinstance(data, Mapping):
        row = _row(category, data)
        if len(row) != len(TLX_SCALES):
            raise InputError(f"questionnaires: nasa_tlx has {len(TLX_SCALES)} {category}")
        data = dict(zip(TLX_SCALES, row, strict=True))
    _check_known("scale of nasa_tlx", data, TLX_SCALES)
    return {name: _answer(name, value) for name, value in data.items()}


def _answer(name: str, value: Any) -> Answer:
    """Return a number or None; non-finite values become None."""
    if value is None:
        return None
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"questionnaires: {name}: '{value}' is not a number") from error
    return number if math.isfinite(number) else None
