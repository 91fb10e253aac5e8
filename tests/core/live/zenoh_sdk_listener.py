"""Another implementation of rmw_zenoh's format listens: `zenoh-ros2-sdk`, not ours.

    PYTHON_WITH_THE_SDK zenoh_sdk_listener.py HOST PORT < REQUEST

The request (JSON) names topics with their types, and has the definition of each type. It comes
late: what it gets are the last messages of transient-local topics. Prints a line of JSON for each.
"""

from __future__ import annotations

import json
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

from zenoh_ros2_sdk import ROS2Subscriber  # type: ignore[import-not-found]
from zenoh_ros2_sdk.message_registry import get_registry  # type: ignore[import-not-found]
from zenoh_ros2_sdk.qos import QosDurability, QosProfile  # type: ignore[import-not-found]


def _summary(message: Any) -> dict[str, Any]:
    if hasattr(message, "info"):
        return {"width": int(message.info.width), "height": int(message.info.height)}
    if hasattr(message, "transforms"):
        return {"children": [t.child_frame_id for t in message.transforms]}
    return {"data": message.data}


def main(host: str, port: int) -> int:
    asked = json.load(sys.stdin)
    late = QosProfile(durability=QosDurability.TRANSIENT_LOCAL, history_depth=1)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in asked["definitions"].items():
            package, _, short = name.partition("/msg/")
            path = Path(folder, package, "msg", f"{short}.msg")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        get_registry(folder)
        missing = set(asked["topics"])
        done = threading.Event()

        def heard(topic: str, message: Any) -> None:
            print(json.dumps({"topic": topic, **_summary(message)}), flush=True)
            missing.discard(topic)
            if not missing:
                done.set()

        kept = [
            ROS2Subscriber(
                t, kind, lambda m, t=t: heard(t, m), qos=late, router_ip=host, router_port=port
            )
            for t, kind in asked["topics"].items()
        ]
        there = done.wait(60.0)
        for subscriber in kept:
            subscriber.close()
    return 0 if there else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2])))
