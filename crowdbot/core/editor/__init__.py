"""Editor: a local page on which a scenario is drawn; comments and order of its YAML are kept.

- `document`: changes of a document's text by ruamel.yaml's round trip.
- `drawn`: the drawing of a text, and its validation messages.
- `play`: ten seconds of it, simulated in a process of its own.
- `desk`: one file that is edited; two editors do not overwrite each other.
- `server`: loopback HTTP with token, Host and Origin checked; `page`: the page.
"""
