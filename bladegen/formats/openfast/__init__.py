"""OpenFAST: AeroDyn blade files, airfoil files with polars, and the main inputs that name them.

In comes a blade file, AeroDyn's input or a turbine's .fst; out goes a definition, or the other
way; `into` puts a blade back into a model; `beams` are ElastoDyn's and BeamDyn's blades.  A new
file of OpenFAST goes here.
"""
