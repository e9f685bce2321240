"""Windows over a page: what to export, what to share, what keys do, what to optimise.

Each is a function that opens one for a page, and takes it away once it is closed.
"""
