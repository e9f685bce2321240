"""Wear of a skin: patterns of it, and a blade that carries it.

In come a blade and depths over span and arc; out go depths [m] at spans and landmarks (`patterns`)
and the blade with its skin moved (`worn`).  A new pattern goes beside those in `patterns`.
"""
