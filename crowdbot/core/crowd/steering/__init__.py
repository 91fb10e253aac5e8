"""Steering parts: behaviour besides the crowd policy, for any policy.

- `parameters`: which parts a crowd has; their numbers are those of `dsl.scenario.steering`.
- `parts`: the table of parts, in the order in which they change what a policy wants.
- `time_gap`, `personal_space`, `lanes`, `wall_push`, `wander`: one compiled part each.
- `moment`, `sorted_discs`: what parts are given: the crowd's view, and people sorted along x.
"""
