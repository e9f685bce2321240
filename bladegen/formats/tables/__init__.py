"""Plain spanwise tables: CSV, and workbooks in the layout of the IEA tabular files.

In come rows of cells; out goes a definition, or the other way.  A new column is a row of the table
in `reading`, and in `writing` if it is to be kept.
"""
