"""Measures of what was made: blades over span, solids and meshes of any file, distances.

In come blades or files; out go figures and findings (`checks`, `spanwise`, `inflections`), and
distances between any two surfaces.  Files of others are read by a process of its own (`foreign`).
A new figure over span goes into `spanwise`, one of the report into `checks`.
"""
