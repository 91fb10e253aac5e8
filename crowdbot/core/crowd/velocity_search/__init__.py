"""Velocity search: costs over candidate velocities, and finding the cheapest.

- `cost`: the interface of cost functions; `cost_calls` calls them by address, `collision` is shared
  by many of them, `minstd` generates their random numbers.
- `neighbour_discs`, `neighbours`: everything that people see as a disc, and neighbour search.
- `surroundings`, `weighted_costs`, `agent_costs`: one decision of all agents, the costs of a
  policy, and the costs of one agent, in the forms that compiled loops take.
- `sampling` (with `candidates`, `search`, and `single` for parity), `gradient`, `optimum`: the
  methods; `evaluate` gives the cost of any velocity.
- `counter_rng`: random numbers that depend on counters only.
"""
