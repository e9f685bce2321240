"""The studio: a blade in the browser, its parameters as sliders.

In comes a `state` (what a page shows, as a frozen value and as the query of a link) and the
`library` of blades it may show; out go a `scene` (surface, curves and checks, made by `model`),
files (`worker`) and the same blade as a command (`recipes`).  A slider is a row of `controls` and a
field of `state`; what stands on the screen goes into `page`, which alone with `server` knows the
web framework.
"""
