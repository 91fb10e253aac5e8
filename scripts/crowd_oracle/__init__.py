"""Comparison of the crowd with recordings of the original engine, step by step.

- `case`: a recorded case; `policy`: its policy and costs as specs of ours.
- `step`: one step of ours from a recorded state; `quirks`: defects of the original, repeated.
- `judge`: which people moved as recorded, and why others did not.
"""
