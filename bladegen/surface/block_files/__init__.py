"""Files of structured blocks, of a surface or of a volume: PLOT3D's records, and the tree of CGNS.

In: blocks of points (ni, nj, nk, 3).  Out: files, or nodes that whoever knows families and
connectivity fills.  A format of blocks that grids and volumes share is a module here.
"""
