"""What the adapters to other libraries share.

In: a parametric blade and names of outputs.  Out: values, and products with their derivatives.
The adapters stand at the package's top, by their libraries' names: `bladegen.openmdao`,
`bladegen.torch`, `bladegen.jax`; none is imported by other modules.
"""
