"""Recordings: MCAP files of ROS 2 messages, with the exact float64 state beside them.

- `recording`: `Recording` reads one back; `writer` writes one, `run_log` collects its events.
- `header`: constants of a run.
- `motion/`: lossless compression of people's motion.
- `container/`: the MCAP file. `reading/`: parts of `Recording`.
- `export/`: bags and tables for other tools.
"""
