"""Many worlds stepped together: the same crowds, robots and rays as in a run, in one compiled call.

- `array_tables`: arrays of many worlds for compiled code.
- `crowd_tables`, `robot_tables`, `scanner_tables`: the arrays of each part.
- `decide`, `drive`, `scan`, `step`: the compiled functions.
- `blueprint`, `world`: a scenario resolved once, and one draw of its people.
- `imagined_crowd`, `compiled_walk`: predicted people, many decisions in one call.
- `batch`: worlds that step together.
"""
