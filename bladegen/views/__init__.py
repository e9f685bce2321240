"""Blades to look at: pictures, diagrams, pages, films, windows.

In come blades and measures; out go PNG, SVG, HTML and films.  A `scene` says what there is to see
and the other modules draw it.  A new diagram over span goes into `blade_plots`.
"""
