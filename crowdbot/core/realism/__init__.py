"""Realism: how human a crowd is, as a number, from people who were recorded in corridors.

- `tracks`: positions at 4 Hz, x along the corridor, of recorded or simulated people.
- `features`: what is compared, person by person and frame by frame; `kinematics` before it.
- `statistics`: histograms and curves of that, which are all that is kept of recordings.
- `compare`: scores of one crowd's statistics beside another's, and the index.
- `model`, `corridor`: a crowd that is simulated where the recorded people walked; `floor` is
  people who avoid nobody.
- `reference`: the recorded people, as shipped or from files of the user; `measure` does all of it.
"""
