from typing import Any

import numpy as np

import crowdbot

t = np.arange(0.0, 10.0, 0.1)
still = np.zeros_like(t)
robot: dict[str, Any] = {
    "t": t,
    "robot_x": 0.5 * t,
    "robot_y": still,
    "robot_theta": still,
    "robot_v": still + 0.5,
    "robot_w": still,
    "robot_radius": 0.18,
    "robot_mass": 6.3,
    "robot_goal_time": 9.9,
}
alone = crowdbot.Trajectories.from_arrays(**robot)
crowded = crowdbot.Trajectories.from_arrays(
    **robot,
    agent_x=np.column_stack([9.0 - t, 20.0 - t]),
    agent_y=np.column_stack([still + 1.0, still - 2.0]),
    agent_radius=0.33,
    agent_mass=75.0,
)
wanted = ["relative_*", "effect_on_velocity", "risk", "min_clearance"]
for score in crowdbot.score(crowded, alone, metrics=wanted, variants="corrected"):
    print(score.metric, score.value, score.unit, score.status, score.reason)
