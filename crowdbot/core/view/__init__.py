"""A scenario drawn from above, before anything is simulated.

A drawing is a list of shapes; SVG, PNG and the page show the same list.
"""
