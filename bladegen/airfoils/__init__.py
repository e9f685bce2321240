"""One section in its own plane: points in, landmarks and measures out.

In come the points of an airfoil, noisy or not; out go n landmarks that mean the same place on
every section (`landmarks`), splines through them with leading edge, thickness and chord
(`section_curves`), chord lines and polars.  A new measure of a section, or a new rule for its
landmarks, goes here; mathematics of any plane curve goes into `curves`.
"""
