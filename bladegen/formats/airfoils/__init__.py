"""Airfoil coordinate files and folders of them: Selig, Lednicer, NuMAD, AeroDyn.

In comes a file of points; out goes a contour from trailing edge to trailing edge in chords, or the
other way.  A new kind of coordinate file goes into `reading`.
"""
