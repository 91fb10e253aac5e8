"""Realism: how human-like a crowd is, compared with people recorded in corridors.

- `tracks`: positions at 4 Hz, x along the corridor, of recorded or simulated people.
- `features`: the compared features, per person and frame; from `kinematics`.
- `statistics`: histograms and curves of the features, which is all that is kept of recordings.
- `compare`: scores of one crowd's statistics against another's, and the index.
- `model`, `corridor`: a crowd simulated where the recorded people walked; `floor` is people without
avoidance.
- `reference`: the recorded people, as shipped or from the user's files; `measure` runs all of it.
"""
