"""Structured grids over a blade.

In: a blade and spacings.  Out: blocks of points, how they join, and files of them.  A new cap is a
module here; a new format is a function in `grid_files` and a row in `exports/registry.py`.
"""
