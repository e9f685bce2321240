"""Statistics of coordinates: how data spread, draws that spread alike, whether two sets do.

In come coordinates (m, r), of a space's data or of families; out come distributions to draw from
(`distributions`, by the densities of `densities`) and tests of two sets (`two_samples`).
"""
