"""The studio: a blade on a page in the browser, its parameters as sliders.

`state` is what a page shows, as a frozen value and as the query of a link; `library` the blades
it may show; `model` makes geometry, curves and checks of both; `charts` draws the curves as
SVG; `recipes` says the same blade as a command; `worker` writes files in a process of its own;
`stage` is the 3D view, `page` the controls around it, `guard` and `server` how it is served.
Only `stage`, `page` and `server` know the web framework.
"""
