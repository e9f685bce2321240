"""Charts of a page as SVG text: of a section's lift and drag, of its layers, of shape modes.

In come answers and arrays, out goes text; nothing here knows the web framework.  Parts that all
charts share stand in `svg`; a new kind of chart is a module here.
"""
