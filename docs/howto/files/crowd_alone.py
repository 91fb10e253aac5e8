import numpy as np

from crowdbot.plugin import Agents, CrowdEngine, CrowdWorld, policy_of

angle = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
x, y = 6.0 * np.cos(angle), 6.0 * np.sin(angle)
agents = Agents.of(x=x, y=y, preferred_speed=1.3, routes=[[p] for p in zip(-x, -y, strict=True)])
policy = policy_of({"kind": "velocity_space"}, {"avoid": {"kind": "ttca_dca", "weight": 20}})
engine = CrowdEngine(agents, CrowdWorld(pillars=np.array([[0.0, 0.0, 0.5]])), policy)
t, place = engine.run(15.0)
away = np.hypot(place[-1, :, 0] + x, place[-1, :, 1] + y)
print(f"{np.sum(away < 0.5)} of {len(agents)} people got across in {t[-1]:g} s")
