"""Beam properties of a blade's sections by PreComp of WISDEM.

In: a blade with webs and layers.  Out: mass and stiffness over span, in SI units and degrees, and
the tables of ElastoDyn and BeamDyn.  The extra `wisdem` installs it; what is computed stands in
`bladegen.blade.layup.beam`.
"""

from bladegen.blade.layup.beam.precomp import beam_properties, require_solver
from bladegen.blade.layup.beam.properties import BeamProperties

__all__ = ["BeamProperties", "beam_properties"]

require_solver()
