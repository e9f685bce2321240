"""Plane curves and polygons: arrays of points and numbers, whatever they stand for.

In come points of many curves at once, or functions of one number; out go places on cubics between
points, roots, areas and moments, crossings and proofs that there are none, compiled maps of the
plane, and products of vectors in space.  What any closed curve could be asked goes here; what needs
a nose goes into `airfoils`.
"""
