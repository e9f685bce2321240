"""Actuator lines: a blade as elements with chord, twist and polars, for LES of whole rotors.

In comes a definition with polars; out go the tables of turbinesFoam (`turbines_foam`) and SOWFA
(`sowfa`), folders of files that a case includes.  Both are of OpenFOAM's syntax.  Another code's
tables are a module here and a writer in `row`.
"""
