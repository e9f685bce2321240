"""HAWC2: the blade of an htc file with its ae and pc files.

In comes an htc file; out goes a definition, or the other way; `into` puts a blade back into a
model.  A new file of HAWC2 goes here.
"""
