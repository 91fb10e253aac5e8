"""Responses of people to robots, other than contact.

- `parameters`: parameters of a response; `from_spec` reads them from a scenario.
- `notice`: detection of robots.
- `evasion`: steering and braking after detection, at each decision.
- `standing`: stopping in front of a standing robot.
"""
