"""What lies inside the skin of a blade: where layers and webs are on its sections, and their mass.

In comes a `Blade` whose definition has a structure; out go fractions of the arc, widths,
thickness, mass and its centre over span (`layup`), and findings on what does not fit (`fit`).
How a new kind of place is found on a section goes into `outlines`.
"""
