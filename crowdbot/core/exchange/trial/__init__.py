"""Trials of the original CrowdBot: config, order, trial XML and recordings, read and written.

A trial's frame is a mirror of ours: our x is its y, our y its x, and headings change sign.
"""
