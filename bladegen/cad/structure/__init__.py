"""A blade's structure as CAD: the skin cut where layers end, webs, and the skin's inner surface.

In come a solid's net and a `Layup`; out go zones of the skin in the net's parameters (`zones`),
the inner surface as a sheet (`inner_part`), and named parts of an assembly (`assembly`).  Another
part of the structure is a module here.
"""
