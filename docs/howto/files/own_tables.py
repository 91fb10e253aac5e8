import csv
import tempfile
from pathlib import Path

import crowdbot

folder = Path(tempfile.mkdtemp())
with (folder / "robot.csv").open("w", newline="") as file:
    rows = csv.writer(file, delimiter=";")
    rows.writerow(["stamp", "east", "north"])
    for k in range(100):
        rows.writerow([f"2026-05-01T10:00:{0.1 * k:06.3f}Z", 0.05 * k, 0.0])
with (folder / "people.csv").open("w", newline="") as file:
    rows = csv.writer(file, delimiter=";")
    rows.writerow(["stamp", "name", "x", "y"])
    for k in range(40):  # another clock, and another rate
        rows.writerow([f"2026-05-01T10:00:{0.23 * k:06.3f}Z", "ada", 5.0 - 0.2 * k, 1.0])

run = crowdbot.Trajectories.from_csv(
    folder / "robot.csv",
    folder / "people.csv",
    columns={
        "robot": {"t": "stamp", "x": "east", "y": "north"},
        "agents": {"t": "stamp", "id": "name"},
    },
    resample="robot",
    robot_radius=0.2,
    robot_mass=20.0,
    robot_goal=(4.5, 0.0),
    robot_goal_radius=0.3,
    robot_speed_limit=1.0,
)
wanted = ["success", "speed", "min_clearance", "safe_efficiency"]
for score in crowdbot.score(run, metrics=wanted):
    value = None if score.value is None else round(score.value, 3)
    print(score.metric, score.variant, value, score.unit, score.status)
