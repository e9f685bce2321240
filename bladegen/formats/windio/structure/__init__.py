"""What lies inside the skin, in windIO's layouts: read into a `Structure`, and written from one.

A way in which windIO gives places goes into the reading and the writing of its version; what both
versions share is in `parts`.
"""
