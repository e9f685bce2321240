"""The command line: parse, call, print.

In comes what a user types; out go files, figures and lines.  Nothing is computed here: a new
option goes beside its command, one of several commands into `options`.
"""
