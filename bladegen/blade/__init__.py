"""A blade as a pure function of span, and its perturbations.

In comes a definition; out go sections at any span.  A `Blade` holds what its sections are
(`shape`: a `loft` through the stations along one of `paths`, deformed), where they stand
(`planform`) and how their edge is finished (`edges`); a perturbation (`perturbation`) makes
another that shares what it does not touch.  A new path, edge, section plane or perturbation goes
here.
"""
