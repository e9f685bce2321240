"""Blades to look at: pictures, pages, films, windows, and what a notebook shows.

In come blades and measures; out go PNG, HTML, films and tables.  What a scene is and how it is
drawn stands in `rendering`, diagrams in `plots`; here is what is made of them.
Another kind of view is a module here.
"""
