"""Match the columns of a table with ours: names, units, frames, wide tables."""
