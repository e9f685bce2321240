"""Diagrams by matplotlib, in one style: of blades over span, of shape spaces, of airfoils' combs.

In come blades, their measures and spaces; out go figures, and files of them.  A new diagram of a
blade goes into `blade_plots`, with a row of `PLOTS`.
"""
