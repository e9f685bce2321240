"""Options that several commands take, and what people write in them.

In come texts of the command line; out go lengths in metres, coordinates, windows and choices
(`parsing`), and groups of options as frozen values (`groups`).  An option that perturbs a blade
goes into `perturbing`, any other into `common`, a way of writing a value into `parsing`.
"""
