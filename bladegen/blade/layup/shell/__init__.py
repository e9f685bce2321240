"""A blade as shells for finite elements: quadrilaterals on skin and webs, their laminates, files.

In comes a `Layup`; out go nodes, elements, sets and sections (`model`), how good the elements are
(`quality`), and a file for Abaqus and CalculiX (`inp`).  Another solver's file is a module here.
"""
