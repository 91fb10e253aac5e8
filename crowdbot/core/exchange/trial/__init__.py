"""The original's trials: config, order of trials, trial XML and recordings, read and written.

x and y of a trial are a mirror of ours: our x is its y, our y its x, and headings change sign.
"""
