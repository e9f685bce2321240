"""Point clouds to surfaces: points in no order, with noise and holes, to a smooth mesh.

In come points (`reading`); out goes a mesh of the surface that they scatter about (`surface`), in
coordinates in which any section is nearly a circle (`coordinates`).  The mesh is then fitted as
any other.
"""
