"""Blade files of other tools, in and out: one package a format, one row each in `registry`.

In comes a path; out goes a `BladeDefinition` (`reading`), or the other way (`writing`, `into`);
what is written is read back and compared first (`proof`).  A new format is a package beside the
others and one row in `registry`; what formats share stands in `common` and `airfoils`.
"""
