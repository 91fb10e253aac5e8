"""Recordings: MCAP files of ROS 2 messages, and the state bit by bit beside them.

- `recording`: `Recording` reads one back; `writer` writes one, `run_log` collects its events.
- `header`: what does not change during a run.
- `motion/`: samples of people, packed without losing a bit.
- `container/`: the MCAP file. `reading/`: what `Recording` consists of.
- `export/`: bags and tables for other tools.
"""
