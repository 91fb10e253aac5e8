"""Many worlds at once: the same crowds, robots and rays as in a run, in one compiled call.

- `array_tables`: arrays of many worlds for compiled code.
- `crowd_tables`, `robot_tables`, `scanner_tables`: what compiled code takes of each.
- `decide`, `drive`, `scan`, `step`: the compiled parts.
- `blueprint`, `world`: a scenario resolved once, and one draw of its people.
- `imagined_crowd`, `compiled_walk`: people whom a planner imagines, many decisions in one call.
- `batch`: worlds that step together.
"""
