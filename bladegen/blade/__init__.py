"""A blade as a pure function of span, and its perturbations.

In comes a definition; out go sections at any span: a path through shapes (`paths`), sizes and
trailing edges (`shape`, `edges`), places in space (`planform`), all perturbed consistently
(`deformation`, `perturbation`).  A new path, edge, section plane or perturbation goes here.
"""
