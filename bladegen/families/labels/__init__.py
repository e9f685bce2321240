"""Labels: what a family's dataset holds besides geometry, computed for each sound variant.

In come a family and a block of its variants; out go columns of the manifest and arrays of the
store (`labelling`).  What each is called, its units and axes stand in `figures`; a new label is a
module with a `Label`, its figures there and its name in `labelling`.
"""
