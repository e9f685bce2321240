"""A blade to files: one row a format, a folder of them, and what each is made from.

In comes a `Blade` and options; out go files that are whole or not there, each with its provenance
in a place of its own, and a report (`build`).  A new exporter is a row in `registry`; whole
folders for a solver are written in `cases`.
"""
