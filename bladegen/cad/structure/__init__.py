"""A blade's structure as CAD: the skin cut where layers end, and webs between its sides.

In come a solid's net and a `Layup`; out go zones of the skin in the net's parameters (`zones`),
and named parts of an assembly (`assembly`).  Another part of the structure is a function there.
"""
