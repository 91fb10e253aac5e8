"""Read columns of numbers from CSV files."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np

from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError


def read_columns(
    path: Path, needed: tuple[str, ...], optional: tuple[str, ...] = ()
) -> dict[str, Array]:
    """Return the columns of a CSV file with a header; empty cells are NaN.

    Raises:
        InputError: it cannot be read, a column is missing, or a cell is not a number (the message
            names the line).
    """
    try:
        with io.StringIO(input_text(path, LARGEST_TABLE), newline="") as file:
            reader = csv.DictReader(file, strict=True)
            header = reader.fieldnames or ()
            missing = [name for name in needed if name not in header]
            if missing:
                raise InputError(f"{path}:1: the column {', '.join(missing)} is missing")
            names = [*needed, *(n for n in optional if n in header)]
            rows = [[_cell(path, reader.line_num, n, row[n]) for n in names] for row in reader]
    except csv.Error as error:
        raise InputError(f"{path}: not a table: {error}") from error
    table = np.array(rows, dtype=np.float64).reshape(len(rows), len(names))
    return {name: table[:, i] for i, name in enumerate(names)}


def _cell(path: Path, line: int, name: str, text: str | None) -> float:
    try:
        if text is None:
            raise ValueError("the row is too short")
        return float(text) if text.strip() else math.nan
    except ValueError as error:
        raise InputError(f"{path}:{line}: {name}: {error}") from error
