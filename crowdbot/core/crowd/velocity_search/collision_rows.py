"""Rows of ``work`` in which the first collision of an agent is searched."""

from __future__ import annotations

from crowdbot.core.crowd.velocity_search.records import WORK_COLUMNS
from crowdbot.core.support.records import record_type


class CollisionHeader:
    """Row 0 of ``work``: number of discs, of wall segments after them, and of those in contact.

    Discs and walls in contact with the agent are not listed.

    Attributes:
        later: the least ``earliest`` of the discs after the last sorted one, s.
        unlisted: distance up to which walls that were not given may be touched, m; 0: none may.
    """

    discs: float
    segments: float
    touched: float
    later: float
    unlisted: float


class DiscRow:
    """A disc in ``work``: relative position, velocity, gap and time.

    Attributes:
        gap2: squared distance minus squared sum of radii, m^2.
        earliest: time before which there is no contact, s.
    """

    x: float
    y: float
    vx: float
    vy: float
    gap2: float
    earliest: float


class SegmentRow:
    """A wall segment in ``work``, after the discs: both ends.

    Attributes:
        later: in the last sorted row, the least ``earliest`` of the rows after it, s; in the first
            row, the row that came first at the last velocity, and 0 before any.
        earliest: as in `DiscRow`.
    """

    ax: float
    ay: float
    bx: float
    by: float
    later: float
    earliest: float


HEADER = record_type(CollisionHeader)
DISC_ROW = record_type(DiscRow, WORK_COLUMNS)
SEGMENT_ROW = record_type(SegmentRow, WORK_COLUMNS)
#: Times before which there is no contact, times this: the rest covers rounding.
SAFE = 1.0 - 1e-12
