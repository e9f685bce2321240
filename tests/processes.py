"""Other processes, looked at from outside: which are there, whose children they are."""

import subprocess
import time


def children(parent):
    """Return the processes that a process has started and that are there."""
    return [pid for pid, (other, _) in _listed().items() if other == parent]


def running(pid):
    """Tell whether a process is there and is more than an entry that nobody has asked for."""
    return not _listed().get(pid, (0, "Z"))[1].startswith("Z")


def gone_within(seconds, pids):
    """Wait until none of some processes is running; tell whether that came in time."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if not any(map(running, pids)):
            return True
        time.sleep(0.05)
    return not any(map(running, pids))


def _listed():
    command = ["ps", "-eo", "pid=,ppid=,stat="]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in listed.splitlines()]
    return {int(pid): (int(parent), state) for pid, parent, state in rows}
