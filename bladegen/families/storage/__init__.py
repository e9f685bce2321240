"""Where families lie: folders of this machine, and object stores under the same names.

In come paths, of `pathlib` or of universal_pathlib, which have the same methods; out come files
that are whole or not there, tables and groups of arrays.  Nothing here knows what a family is.
"""
