"""A planner that thinks with PyTorch; crowdbot's own Python need not have it."""

from typing import Any

import torch

SECTORS = 16


class TorchPlanner:
    """Turns to the goal and away from what the front lidar sees, and slows down near it."""

    needs = ("front_lidar",)

    def reset(self, task: Any, limits: Any, sensors: Any, seed: int) -> None:
        torch.manual_seed(seed)
        torch.set_num_threads(1)
        torch.use_deterministic_algorithms(True)
        self.v_max, self.w_max = limits.v_max, limits.w_max
        self.policy = torch.nn.Linear(SECTORS + 1, 2, bias=False, dtype=torch.float64)
        side = torch.linspace(-1.0, 1.0, SECTORS, dtype=torch.float64)
        with torch.no_grad():  # a real planner loads weights here, and declares them as its data
            self.policy.weight[0] = torch.cat([-torch.exp(-4.0 * side**2), torch.zeros(1)])
            self.policy.weight[1] = torch.cat([-0.5 * torch.sign(side), torch.ones(1)])

    def step(self, obs: Any) -> tuple[float, float]:
        with torch.inference_mode():
            ranges = obs.readings["front_lidar"].values
            near = torch.tensor(ranges, dtype=torch.float64).clamp(max=8.0)
            near = near.reshape(SECTORS, -1).amin(dim=1)
            x, y = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
            ahead = torch.atan2(torch.tensor(y), torch.tensor(x)) - obs.pose.yaw
            seen = torch.cat([torch.exp(-2.0 * near), torch.sin(ahead).double().reshape(1)])
            slow, turn = self.policy(seen).tolist()
            return self.v_max * max(0.0, 1.0 + slow), self.w_max * max(-1.0, min(1.0, turn))
