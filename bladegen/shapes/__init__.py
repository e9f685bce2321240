"""Sections as points of the Grassmannian Gr(n, 2): shape apart from affine maps.

In come landmarks; out go a point of Gr(n, 2) and an affine map (`affine`), geodesics and parallel
transport (`grassmann`), and spaces of shapes with coordinates (`shape_space`), learned from any
airfoils.  A new way to learn a space, or new coordinates of shapes, goes here.
"""
