"""Responses of people to robots, contact apart.

- `parameters`: what of a response can be chosen; `from_spec` takes it from a scenario.
- `notice`: who has noticed a robot.
- `evasion`: how those who have steer and brake, decided with their way.
- `standing`: how people stop short of a robot that stands.
"""
