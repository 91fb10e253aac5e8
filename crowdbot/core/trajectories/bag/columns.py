"""Tables of the bodies in a topic's messages: time, frame and position."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Columns:
    """K rows, in the order of their recording.

    Attributes:
        log: (K,) times of recording, ns since 1970.
        stamp: (K,) times of the headers, ns; 0 where there is none.
        message: (K,) number of the message in its topic.
        row: (K,) numbers of the original rows.
        frame: (K,) names of frames, without a leading slash; empty where unknown.
        xyz: (K, 3) positions in that frame, m.
        values: further columns (K,) by name, NaN where unknown.
    """

    log: NDArray[np.int64]
    stamp: NDArray[np.int64]
    message: NDArray[np.int64]
    row: NDArray[np.int64]
    frame: NDArray[Any]
    xyz: Array
    values: dict[str, Array]

    def __len__(self) -> int:
        return len(self.log)

    def only(self, rows: NDArray[Any]) -> Columns:
        """Return some rows, by a mask (K,) or by indices."""
        return replace(
            self,
            log=self.log[rows],
            stamp=self.stamp[rows],
            message=self.message[rows],
            row=self.row[rows],
            frame=self.frame[rows],
            xyz=self.xyz[rows],
            values={name: column[rows] for name, column in self.values.items()},
        )


@dataclass(slots=True)
class BodyRow:
    """A body in a message, as one row.

    Attributes:
        labels: names that the message has for the body, by field.
        group: namespace and shape of a marker; empty for other messages.
        role: ``person``, or what else the message says it is.
    """

    log: int
    stamp: int
    message: int
    frame: str
    xyz: tuple[float, float, float]
    values: dict[str, float]
    labels: dict[str, str]
    group: str = ""
    role: str = "person"


def columns_of(rows: Sequence[BodyRow]) -> Columns:
    """Return the columns of rows, which may be none."""
    names = dict.fromkeys(name for row in rows for name in row.values)
    return Columns(
        log=np.array([row.log for row in rows], np.int64),
        stamp=np.array([row.stamp for row in rows], np.int64),
        message=np.array([row.message for row in rows], np.int64),
        row=np.arange(len(rows)),
        frame=np.array([row.frame for row in rows], object),
        xyz=np.array([row.xyz for row in rows], np.float64).reshape(-1, 3),
        values={n: np.array([row.values.get(n, np.nan) for row in rows], float) for n in names},
    )
