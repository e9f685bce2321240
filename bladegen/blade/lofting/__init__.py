"""The stations' airfoils joined over span: paths on the Grassmannian, affine maps, edge widths.

In: airfoils at stations.  Out: sections in chords at any span, before anything is perturbed
(`loft`), and what all variants of a blade share.  A new path goes into `paths`.
"""
