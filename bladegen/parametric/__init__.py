"""Blades as differentiable functions of parameters.

In: a blade, a shape space and names of parameters.  Out: sections, surfaces and quantities at
vectors of parameters, with exact derivatives.  A new parameter is a name in
`parameters` and its derivatives in `chain`; a new quantity stands in `quantities`;
what frameworks share is in `adapters`.
"""
