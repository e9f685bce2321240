"""Hypothesis: the same examples on every run, more in `make test-all`, new ones to explore.

HYPOTHESIS_PROFILE is one of `steady`, `thorough` and `explore`.
"""

import os

from hypothesis import settings

settings.register_profile("steady", deadline=None, max_examples=40, derandomize=True)
settings.register_profile("thorough", deadline=None, max_examples=100, derandomize=True)
settings.register_profile("explore", deadline=None, max_examples=200, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))
