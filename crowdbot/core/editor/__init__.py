"""Editor: a local page that draws a scenario, and writes its YAML with comments and order kept.

- `document`: changes of a document's text by ruamel.yaml's round trip.
- `drawn`: what a text draws, and the language's own messages about it.
- `play`: ten seconds of it, simulated in a process of its own.
- `desk`: one file that is edited; two editors do not overwrite each other.
- `server`: loopback HTTP with token, Host and Origin checked; `page`: the page.
"""
