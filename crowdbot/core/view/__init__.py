"""Draw a scenario from above, before the simulation.

A drawing is a list of shapes, shared by SVG, PNG and the page.
"""
