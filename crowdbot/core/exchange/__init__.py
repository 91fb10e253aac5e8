"""Exchange: read and write scenes of other simulators, with a report of losses.

- `item`, `xml_items`, `text_items`: files of others as trees whose parts know their position.
- `rows`: tables of element -> our field; the page of the *Rosetta stone* is made from them.
- `report`: what was carried over, interpreted, left out or added, and where.
- `scene`, `write`: what was found, in our words, and as YAML whose lines know their origin.
- `formats`: every format by the look of its files; `importing`: files in, documents out.
- `umans`, `trial`, `others`: the readers.
"""
