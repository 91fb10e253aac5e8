"""Steering parts: behaviour in addition to the crowd policy, for any policy.

- `parameters`: the parts of a crowd; their fields are those of `dsl.scenario.steering`.
- `parts`: the table of parts, in the order in which they are applied.
- `time_gap`, `personal_space`, `lanes`, `wall_push`, `wander`: one compiled part each.
- `moment`, `sorted_discs`: the input of parts: the crowd's view, and people sorted along x.
"""
