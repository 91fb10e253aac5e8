"""Static frames of a robot's links, from its URDF."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple
from xml.etree import ElementTree as Xml

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.geometry.rotation import rotation
from crowdbot.core.recording.joints import UrdfJoint, urdf_joints
from crowdbot.core.recording.namespace import in_namespace

#: Joints of which the child does not move: a run holds those with limits at zero.
_HELD = ("fixed", "revolute", "prismatic")


class _Step(NamedTuple):
    """A joint, walked from its parent to its child, or back."""

    joint: UrdfJoint
    back: bool

    @property
    def ends(self) -> tuple[str, str]:
        """Return the link where it begins, and the one where it ends."""
        ends = self.joint.parent, self.joint.child
        return ends[::-1] if self.back else ends


def link_frames(description: str, namespace: str, known: Sequence[str]) -> Iterator[Any]:
    """Yield a static transform for each link that is fixed to a known frame.

    Args:
        description: the robot's URDF; may be empty.
        namespace: of the robot's frames.
        known: frames that have a transform, with the namespace, from the floor up; the links that
            have their names get no other one.
    """
    if not description:
        return
    root = Xml.fromstring(description)  # noqa: S314 - written by crowdbot itself
    rigid = [joint for joint in urdf_joints(root) if joint.kind in _HELD]
    steps = [_Step(joint, back) for joint in rigid for back in (False, True)]
    place = {link: in_namespace(namespace, link) for step in steps for link in step.ends}
    links = {frame: link for link, frame in place.items()}
    reached = [links[frame] for frame in known if frame in links]
    for link in reached:  # grows meanwhile
        for step in steps:
            begin, end = step.ends
            if begin == link and end not in reached:
                reached.append(end)
                yield _transform(step, place[begin], place[end])


def _transform(step: _Step, parent: str, child: str) -> Any:
    at, turn = step.joint.at, step.joint.turn
    if step.back:
        x, y, z = (rotation(*step.joint.rpy).T @ -np.array(at)).tolist()
        at, turn = (x, y, z), (-turn[0], -turn[1], -turn[2], turn[3])
    message = ros.transform(0, parent, child, at, 0.0)
    turned = dict(zip("xyzw", turn, strict=True))
    message.transform.rotation = ros.new("geometry_msgs/Quaternion", **turned)
    return message
