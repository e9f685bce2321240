"""Sections of a surface: planes cut it, and outlines open at their trailing edges.

In come a surface and planes; out go closed outlines (`cutting`, `chains`), opened where the
trailing edge is (`edges`), and landmarks on them (`outlines`).  How another kind of source is cut
goes here.
"""
