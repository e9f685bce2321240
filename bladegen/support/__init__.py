"""Ground floor: what every room uses and none owns.

Read-only arrays and affine maps of points, arguments checked as people write them, files that are
whole or not there, workers that end with their parent, signals, compiled functions.  A new thing
belongs here only if it knows nothing of blades.
"""
