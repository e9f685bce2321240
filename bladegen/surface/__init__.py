"""A blade's surface: B-spline net, triangle meshes, structured grids, tips.

In comes a `Blade`; out go control points (`net`), closed triangle meshes (`mesh`), blocks of
quadrilaterals (`grid`) and their files.  A new tip goes into `tips`, a new mesh here, a new
grid into `grids`.
"""
