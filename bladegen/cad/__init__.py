"""Solids and CAD files, by OCCT.

In comes a surface's net; out goes one closed solid (`solids`), STEP, IGES and BREP (`exchange`),
or a rotor of them.  A new solid, or a new CAD format, goes here.
"""
