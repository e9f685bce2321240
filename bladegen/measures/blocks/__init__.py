"""Structured grids from any file: read, and measured as they lie there.

In: PLOT3D and CGNS files.  Out: blocks of points (ni, nj, nk, 3), and figures of surfaces and
volumes.  Another file of structured blocks is a function in `reading`.
"""
