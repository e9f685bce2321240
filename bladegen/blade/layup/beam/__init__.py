"""A blade as a beam: mass and stiffness over span, and its modes.

In comes a `Blade` with webs and layers; a section solver of others (`precomp`) makes
`BeamProperties` of its sections; `modes` are those of the clamped beam; `table` is the lines of a
table.  Another solver goes beside `precomp`; the files of a tool go to that tool's format, as those
of ElastoDyn and BeamDyn do (`formats.openfast.beams`).
"""
