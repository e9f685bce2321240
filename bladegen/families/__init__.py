"""Families: many perturbed variants of one blade, planned, tested and written.

In come a blade, a space and a design; out come variants one by one (`family`), or a folder of them
that runs can resume (`run`, `folder`).  A new file of a family's folder goes here.
"""
