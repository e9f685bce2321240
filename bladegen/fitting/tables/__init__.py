"""Tables of points: columns with names and units, and sections in them, to points or a mesh.

In comes text with a row a point; out go its columns (`reading`), and where its rows are sections
of a blade, one after the other, the surface through them (`lofting`).
"""
