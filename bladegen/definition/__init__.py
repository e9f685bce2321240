"""What a designer gives: airfoils at stations, and distributions over span.

In come plain numbers, whatever file they are from; out goes a `BladeDefinition`, a frozen value in
metres and radians, with findings on what looks odd.  A new quantity of a blade, or a new doubt
about one, goes here.
"""
