"""Comparison of people's response to robots with people recorded near robots and vehicles.

- `clip`: a recording of one robot among people; `recordings` reads them.
- `encounters`: meetings of one person and the robot in a clip.
- `features`: numbers of an encounter; `statistics`: their distributions by cell.
- `scenes`: encounters drawn from shipped statistics; `replay` simulates the person in an encounter.
- `compare`: distance of two distributions; `reference`, `measure`: the index.
"""
