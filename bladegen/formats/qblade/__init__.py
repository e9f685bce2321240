"""QBlade blade definition files (.bld); read only.

In comes a file; out goes a definition.
"""
