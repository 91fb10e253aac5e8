"""Live picture of a run on the person's page, in the data format of the replay page."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from crowdbot.core.live.person.page_server import PageServer
from crowdbot.core.planning.planner import TRACKS, Observation
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.replay.encode import scenery_numbers
from crowdbot.core.replay.encode_robot import robot_numbers
from crowdbot.core.robots.look import seen_from_above
from crowdbot.core.runs.replayed import scenery
from crowdbot.core.runs.solids import solid_people, solids_of
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.scenario import Scenario

_BEAMS = 240
#: Motion is sent in millimetres and milliradians.
_FINE = 1000.0


class LivePicture:
    """A watcher that shows each sample of a run to all pages."""

    def __init__(
        self,
        server: PageServer,
        scenario: Scenario,
        parts: EnvironmentParts,
        builts: Mapping[str, BuiltRun],
        people: Realisation,
        about: Mapping[str, Any],
    ) -> None:
        """Prepare a run's picture. ``about``: more fields of the scene."""
        self._server, self._builts = server, builts
        self.look: Callable[[], Mapping[str, Observation]] = dict
        self._drawn: dict[tuple[str, str], dict[str, Any]] = {}  # by robot and name
        models = {name: built.model for name, built in builts.items()}
        highest = max((model.height for model in models.values()), default=0.0)
        self._lidars = {
            name: {n: info for n, info in built.infos.items() if _is_flat_lidar(info.angles)}
            for name, built in builts.items()
        }
        count, shown = len(people), [_robot(name, built) for name, built in builts.items()]
        self._scene = {
            **about,
            **scenery_numbers(scenery(parts, highest or 2.0)),
            "zone": shown[0]["zone"] if shown else [],
            "robots": shown,
            "people": {
                "count": count,
                "id": np.asarray(people.id).tolist(),
                "radius": np.round(people.radius, 3).tolist(),
            },
            "solids": solids_of(
                parts,
                {name: (built.model, built.infos) for name, built in builts.items()},
                solid_people(scenario, people),
            ),
        }

    def begin_run(self, look: Callable[[], Mapping[str, Observation]]) -> None:
        """Start a recording; ``look`` returns the observations of all robots."""
        self.look = look

    def show(self) -> None:
        """Show the static scene before the run begins."""
        self._server.show_scene(self._scene)

    def begin(self, shared: RecordingHeader, robots: Mapping[str, RecordingHeader]) -> None:
        """Show the scene at the start of a recording."""
        del shared, robots
        self._drawn.clear()
        self.show()

    def sample(self, t: float, robots: Mapping[str, Sequence[float]], agents: Array | None) -> None:
        """Show one sample."""
        found = [robots.get(name) for name in self._builts]
        self._server.show_frame(
            {
                "t": t,
                "robots": [None if row is None else _fine(row[:5]) for row in found],
                "people": [] if agents is None else [_fine(row) for row in agents],
                "scans": self._scans(robots),
                "drawings": list(self._drawn.values()),
            }
        )
        self._drawn.clear()

    def drawing(
        self,
        t: float,
        robot: str,
        name: str,
        columns: Array,
        texts: Sequence[str] | None = None,
    ) -> None:
        """Show a planner's latest drawing with the next sample."""
        self._drawn[robot, name] = {
            "robot": robot, "name": name, "t": t, "tracks": name == TRACKS,
            "columns": np.round(columns, 2).tolist(),
            **({} if texts is None else {"texts": list(texts)}),
        }  # fmt: skip

    def _scans(self, robots: Mapping[str, Sequence[float]]) -> list[dict[str, Any]]:
        """Return the latest hits of planar lidars, placed from the robots' true poses."""
        if not any(self._lidars.values()):
            return []
        scans = []
        for name, obs in self.look().items():
            if name not in robots:
                continue
            for sensor, info in self._lidars[name].items():
                if sensor in obs.readings:
                    scans.append(_scan(info, obs.readings[sensor].values, robots[name][:3]))
        return scans


def _is_flat_lidar(angles: Array | None) -> bool:
    return angles is not None and angles.ndim == 1 and len(angles) > 2


def _robot(name: str, built: BuiltRun) -> dict[str, Any]:
    model, task = built.model, built.task
    look = [(part.outline, part.colour) for part in seen_from_above(model)]
    return {
        **robot_numbers(name, model.footprint_radius, model.footprint, task.goal_zone, look),
        "wanted": [] if built.target is None else built.target.rows.tolist(),
        "goal": list(task.goal),
        "goalRadius": 0.0,
        "start": list(task.start),
        "limit": task.time_limit,
    }


def _scan(info: Any, ranges: Array, pose: Sequence[float]) -> dict[str, Any]:
    """Return the sensor's place and the hits: x, y in turn, m, world frame; height above the base.

    Roll and pitch of the mount are left aside.
    """
    every = max(1, -(-len(info.angles) // _BEAMS))
    angles, ranges = info.angles[::every], np.asarray(ranges)[::every]
    x, y, yaw = pose
    mx, my, mz, turned = info.mount
    c, s = math.cos(yaw), math.sin(yaw)
    at = (x + c * mx - s * my, y + s * mx + c * my)
    hit = np.isfinite(ranges) & (ranges < info.range_max)
    way = angles[hit] + yaw + turned
    hits = np.column_stack([at[0] + ranges[hit] * np.cos(way), at[1] + ranges[hit] * np.sin(way)])
    return {
        "x": round(at[0], 3), "y": round(at[1], 3), "z": round(mz, 3),
        "hits": np.round(hits, 2).ravel().tolist(),
    }  # fmt: skip


def _fine(row: Any) -> list[int | None]:
    """Return numbers as whole thousandths; None where a person is absent."""
    return [round(v * _FINE) if math.isfinite(v) else None for v in np.asarray(row).tolist()]
