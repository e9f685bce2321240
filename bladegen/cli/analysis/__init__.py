"""Commands that compute what a blade does: a command is a module here, imported by `commands`.

In comes what a user types, out go figures; options that several commands share are in `options`.
"""
