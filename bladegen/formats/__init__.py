"""Blade files of other tools, in and out: one package a format.

In comes a path; out goes a `BladeDefinition` (`reading`), or the other way (`writing`, `into`);
what is written is read back and compared first (`proof`).  A new format is a package beside the
others and one row in the tables of `reading` and `writing`; what formats share stands in `common`.
"""
