"""Datasets: a family's folder as one store that learners open.

In comes a family's folder whose manifest is whole; out come the arrays beside its sections with
names, dimensions and units (`store`), a data card (`card`), and values that read it (`loading`).  A
new variable is a row in `variables`.
"""
