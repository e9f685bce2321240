"""What tests share, and how many examples Hypothesis draws.

HYPOTHESIS_PROFILE is `steady`, the same examples on every run; `thorough`, more of them, for
`make test-all`; or `explore`, new ones each time.
"""

import os
import signal
from pathlib import Path

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


@pytest.fixture(scope="module", autouse=True)
def _broken_pipes_are_errors():
    """No library may set SIGPIPE back: a later write into a closed pipe would end this process."""
    yield
    status = Path("/proc/self/status")
    if status.is_file():
        fields = dict(line.split(":") for line in status.read_text().splitlines())
        assert int(fields["SigIgn"], 16) >> signal.SIGPIPE - 1 & 1, "SIGPIPE is not ignored"
