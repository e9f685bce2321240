"""A blade as a beam: mass and stiffness over span, its modes, and the files that tools take.

In comes a `Blade` with webs and layers; a section solver of others (`precomp`) makes
`BeamProperties` of its sections; `modes` are those of the clamped beam; `openfast` and `table` are
the lines of files.  Another solver goes beside `precomp`, another tool's file beside `openfast`.
"""
