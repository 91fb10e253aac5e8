"""The simulation; the only part of core that imports Drake."""
