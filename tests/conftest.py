"""What tests share, and how many examples Hypothesis draws.

HYPOTHESIS_PROFILE is `steady`, the same examples on every run; `thorough`, more of them, for
`make test-all`; or `explore`, new ones each time.
"""

import os

import pytest
import zygote
from hypothesis import settings

settings.register_profile("steady", deadline=None, max_examples=15, derandomize=True)
settings.register_profile("thorough", deadline=None, max_examples=100, derandomize=True)
settings.register_profile("explore", deadline=None, max_examples=200, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))


@pytest.fixture(scope="session")
def command():
    """Run bladegen's commands, and scripts, in processes that have imported what is slow."""
    with zygote.Commands() as commands:
        yield commands
