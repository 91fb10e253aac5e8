"""Rows as a pandas data frame or an Arrow table, if these are installed."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

from crowdbot.errors import InputError

if TYPE_CHECKING:
    import pandas as pd  # type: ignore[import-untyped]
    import pyarrow as pa  # type: ignore[import-untyped]

#: Columns that are numeric even if every cell is empty.
NUMBERS = ("value", "lower", "upper", "goal_time", "sim_time", "wall_time", "density")


def to_pandas(rows: Sequence[Mapping[str, Any]], columns: Sequence[str]) -> pd.DataFrame:
    """Return a data frame; missing numbers are NaN.

    Args:
        rows: one mapping per row.
        columns: names, in order.

    Raises:
        InputError: pandas is not installed.
    """
    pandas = _library("pandas")
    frame = pandas.DataFrame({n: [row[n] for row in rows] for n in columns}, columns=list(columns))
    numbers = {n: "float64" for n in columns if n in NUMBERS}
    return frame.astype(numbers)


def to_arrow(rows: Sequence[Mapping[str, Any]], columns: Sequence[str]) -> pa.Table:
    """Return an Arrow table; missing values are null.

    Args:
        rows: one mapping per row.
        columns: names, in order.

    Raises:
        InputError: pyarrow is not installed.
    """
    arrow = _library("pyarrow")
    arrays = {
        n: arrow.array([row[n] for row in rows], type=arrow.float64() if n in NUMBERS else None)
        for n in columns
    }
    return arrow.table(arrays)


def _library(name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise InputError(
            f"{name} is not installed; pip install 'crowdbot[analysis]' brings it"
        ) from error
