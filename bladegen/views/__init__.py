"""Blades to look at: pictures, pages, films, windows, and what a notebook shows.

In come blades and measures; out go PNG, HTML and films.  A `scene` says what there is to see, and
the other modules draw it.  Another quantity as colour goes into `blade_scene`.
"""
