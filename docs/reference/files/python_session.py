import crowdbot

scenario = crowdbot.load(
    "challenge-2020",
    "counter-d0250-dispersed-c20-r05",
    set={"robots.robot.task.time_limit": 2},
)
with crowdbot.Session(scenario, seed=1, sensors=["lidar"]) as session:
    obs = session.reset()
    while not session.done:
        nearest = min(float(r.values.min()) for r in obs.readings.values())
        obs = session.step((0.3 if nearest > 0.8 else 0.0, 0.0))
print(session.status, session.t)
