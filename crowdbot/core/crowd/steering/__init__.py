"""Steering parts: behaviour in addition to the crowd policy, for any policy.

- `parameters`: the parts of a crowd; their fields are those of `dsl.scenario.steering`.
- `parts`: the table of parts, and all of them in the order in which they are applied.
- `time_gap`, `personal_space`, `lanes`, `wall_push`, `wander`: one compiled part each.
- `sorted_discs`: the input of parts: people sorted along x.
"""
