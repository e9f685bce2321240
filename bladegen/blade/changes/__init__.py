"""What a perturbation changes, and where along the span: values that know no blade.

In: shapes, distributions and parameters.  Out: shapes deformed along modes (`deformation`), chord,
twist and thickness changed (`affine_change`), weights over span (`window`).  A new kind of
change is a module here; `blade/perturbation.py` asks for it.
"""
