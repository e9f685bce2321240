"""A blade as a pure function of span, and its perturbations.

In comes a definition; out go sections at any span.  A `Blade` holds what its sections are
(`shape`: `lofting` through the stations, deformed), where they stand (`planform`) and how their
edge is finished (`edges`); a perturbation (`perturbation`, of `changes`) makes another that shares
what it does not touch.  A new path goes into `lofting`, a new change into `changes`, a new edge or
section plane here.  What is known of a blade as a whole has packages of its own: what lies inside
its skin `layup`, what the wind makes of it `aero`, its variants by the thousand `variants`.
"""
