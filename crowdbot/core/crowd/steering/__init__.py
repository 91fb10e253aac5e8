"""Steering parts: what people do beside their crowd policy, whatever that is.

- `parameters`: what of each part can be chosen; `from_spec` takes it from a scenario.
- `parts`: the list of parts, in the order in which they change what a policy wants.
- `time_gap`, `personal_space`, `lanes`, `wall_push`, `wander`: one compiled part each.
- `around`: what parts are given: who is where, sorted along x.
"""
