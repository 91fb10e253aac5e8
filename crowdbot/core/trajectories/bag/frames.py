"""Transforms between frames of a bag, from /tf, /tf_static and odometry."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

#: Topics of transforms; those of the second do not change.
TF, TF_STATIC = "/tf", "/tf_static"
#: A transform holds this much longer than it was sent, s.
_HOLDS = 1.0


class Edge(NamedTuple):
    """A transform of a child's frame into its parent's, as it was sent."""

    log: int
    stamp: int
    parent: str
    child: str
    xyz: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]
    is_static: bool


@dataclass(frozen=True, slots=True)
class _Link:
    """All transforms of a child: times (K,), ns; translations (K, 3); quaternions (K, 4)."""

    parent: str
    t: NDArray[np.int64]
    xyz: Array
    quaternion: Array
    is_static: bool

    def at(self, t: NDArray[np.int64]) -> tuple[Rotation, Array]:
        """Return rotation and translation at times (N,), ns; NaN long before or after all."""
        from scipy.spatial.transform import Rotation  # a third of a second

        if self.is_static or len(self.t) == 1:
            rows = np.full(len(t), len(self.t) - 1)
            return Rotation.from_quat(self.quaternion[rows]), self.xyz[rows]
        after = np.clip(np.searchsorted(self.t, t), 1, len(self.t) - 1)
        span = (self.t[after] - self.t[after - 1]).astype(float)
        part = np.clip((t - self.t[after - 1]) / np.maximum(span, 1.0), 0.0, 1.0)[:, None]
        quaternion = (1.0 - part) * self.quaternion[after - 1] + part * self.quaternion[after]
        xyz = (1.0 - part) * self.xyz[after - 1] + part * self.xyz[after]
        late = (t < self.t[0] - _HOLDS * 1e9) | (t > self.t[-1] + _HOLDS * 1e9)
        return Rotation.from_quat(quaternion), np.where(late[:, None], np.nan, xyz)


class FrameTree:
    """Frames with the transforms to their parents.

    Args:
        edges: as they were sent.
        by_stamp: True to use their stamps as times, False to use the times of recording.
    """

    def __init__(self, edges: Iterable[Edge], *, by_stamp: bool) -> None:
        found: dict[str, list[Edge]] = {}
        for edge in edges:
            if edge.child != edge.parent and np.linalg.norm(edge.quaternion) > 0.5:
                found.setdefault(edge.child, []).append(edge)
        self._links = {child: _link(sent, by_stamp) for child, sent in found.items()}

    def __contains__(self, frame: str) -> bool:
        return frame in self._links or any(link.parent == frame for link in self._links.values())

    @property
    def frames(self) -> list[str]:
        """Return all frames, sorted."""
        return sorted({*self._links, *(link.parent for link in self._links.values())})

    def above(self, frame: str) -> list[str]:
        """Return a frame and its ancestors, up to the root."""
        chain = [frame]
        while (link := self._links.get(chain[-1])) is not None and link.parent not in chain:
            chain.append(link.parent)
        return chain

    def is_moving(self, frame: str) -> bool:
        """Return True if a transform between a frame and the root changes its value."""
        return any(
            (link := self._links.get(name)) is not None and len(np.unique(link.xyz, axis=0)) > 1
            for name in self.above(frame)
        )

    def times(self, frame: str, target: str) -> NDArray[np.int64]:
        """Return times, ns, of the transform that was sent most often between two frames."""
        moving = list(self._moving(frame, target).values())
        longest = max(moving, key=lambda link: len(link.t))
        begin, end = max(link.t[0] for link in moving), min(link.t[-1] for link in moving)
        during: NDArray[np.int64] = longest.t[(longest.t >= begin) & (longest.t <= end)]
        return during

    def cut_short(self, frame: str, target: str) -> list[str]:
        """Return sentences on transforms that begin later or end earlier than others, by seconds.

        Poses between two frames (see `times`) are known only while all are sent.
        """
        moving = self._moving(frame, target)
        first, last = min(k.t[0] for k in moving.values()), max(k.t[-1] for k in moving.values())
        return [
            f"the transform from '{name}' to '{link.parent}' is sent from {begin:.3g} to "
            f"{end:.3g} s of {(last - first) / 1e9:.3g} s: other poses are left out"
            for name, link in moving.items()
            for begin, end in [((link.t[0] - first) / 1e9, (link.t[-1] - first) / 1e9)]
            if begin > _HOLDS or (last - link.t[-1]) / 1e9 > _HOLDS
        ]

    def _moving(self, frame: str, target: str) -> dict[str, _Link]:
        """Return the transforms between two frames that are sent again, else all, by child."""
        chain = self.above(frame)
        links = {name: self._links[name] for name in chain[: chain.index(target)]}
        return {name: link for name, link in links.items() if not link.is_static} or links

    def between(
        self, target: str, source: str, t: NDArray[np.int64]
    ) -> tuple[Rotation, Array] | None:
        """Return the transform of points from ``source`` to ``target``; None if not connected.

        Args:
            target, source: frames.
            t: (N,) times, ns.
        """
        up, down = self.above(source), self.above(target)
        common = next((frame for frame in up if frame in down), None)
        if common is None:
            return None
        turn, at = self._chain(up[: up.index(common)], t)
        back, origin = self._chain(down[: down.index(common)], t)
        inverse = back.inv()
        return inverse * turn, inverse.apply(at - origin)

    def _chain(self, frames: list[str], t: NDArray[np.int64]) -> tuple[Rotation, Array]:
        from scipy.spatial.transform import Rotation

        turn, at = Rotation.identity(len(t)), np.zeros((len(t), 3))
        for frame in frames:
            r, p = self._links[frame].at(t)
            turn, at = r * turn, r.apply(at) + p
        return turn, at


def _link(sent: list[Edge], by_stamp: bool) -> _Link:
    parent = sent[-1].parent
    sent = [edge for edge in sent if edge.parent == parent]
    t = np.array([edge.stamp if by_stamp else edge.log for edge in sent], np.int64)
    t, first = np.unique(t, return_index=True)
    quaternion = np.array([sent[i].quaternion for i in first])
    quaternion = quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)
    turns = np.sum(quaternion[1:] * quaternion[:-1], axis=1) < 0.0
    quaternion[1:] *= np.where(np.cumsum(turns) % 2 == 1, -1.0, 1.0)[:, None]
    return _Link(
        parent, t, np.array([sent[i].xyz for i in first]), quaternion,
        all(edge.is_static for edge in sent),
    )  # fmt: skip


def edges_of(message: Any, log: int, topic: str) -> Iterable[Edge]:
    """Yield the transforms of a message of /tf or /tf_static."""
    for sent in getattr(message, "transforms", ()):
        xyz, turn = sent.transform.translation, sent.transform.rotation
        yield Edge(
            log, 10**9 * int(sent.header.stamp.sec) + int(sent.header.stamp.nanosec),
            str(sent.header.frame_id).lstrip("/"), str(sent.child_frame_id).lstrip("/"),
            (float(xyz.x), float(xyz.y), float(xyz.z)),
            (float(turn.x), float(turn.y), float(turn.z), float(turn.w)), topic == TF_STATIC,
        )  # fmt: skip
