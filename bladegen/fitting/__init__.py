"""From points to a blade: surfaces and scans of unknown origin to a definition.

In come files or arrays of points and triangles; out goes a `Fitted` (`fitted`): a definition that
every other command reads, where it lies in the file, and how far it is from it over span.  Where a
blade lies is found in `pose`, sections in `cutting` and `outlines`; a new kind of source goes
beside them.
"""
