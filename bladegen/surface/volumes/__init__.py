"""Volumes of hexahedra around a blade, grown from its structured grid in layers.

In: a grid of the surface.  Out: blocks of points that match point to point, how good their cells
are, and files of them.  How layers follow each other is in `marching`; a new measure of cells is a
function of `volume_quality`, a new format one of `volume_files`.
"""
