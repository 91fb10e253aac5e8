"""The program on the other side. It knows JSON and nothing of crowdbot."""

from __future__ import annotations

import json
import math
import sys
from typing import Any

_STOP = 0.5  # m


def main() -> None:
    """Answer line by line until the input ends."""
    limits: dict[str, float] = {}
    for line in sys.stdin:
        message = json.loads(line)
        if "reset" in message:
            limits = message["reset"]["limits"]
            answer: dict[str, Any] = {"ready": True}
        else:
            answer = step(message["step"], limits)
        print(json.dumps(answer), flush=True)


def step(seen: dict[str, Any], limits: dict[str, float]) -> dict[str, Any]:
    """To the goal; stands while anything is near."""
    x, y, yaw = seen["pose"]
    dx, dy = seen["goal"][0] - x, seen["goal"][1] - y
    error = math.remainder(math.atan2(dy, dx) - yaw, math.tau)
    near = [d for d in seen["nearest"].values() if d is not None]
    v = 0.0 if min(near, default=math.inf) < _STOP else limits["v_max"] * max(0.0, math.cos(error))
    most = limits["w_max"]
    return {"v": min(v, math.hypot(dx, dy)), "w": max(-most, min(most, 2.0 * error))}


if __name__ == "__main__":
    main()
