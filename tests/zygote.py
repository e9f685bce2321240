"""A process that has imported what is slow, and runs bladegen's commands in forks of itself.

Real commands in real processes, without the seconds that importing OCCT and VTK takes each time.
It reads one request a line from stdin, a JSON list of jobs that run at once, and answers a list:

    {"args": [...]}   what follows `bladegen` on the command line, or what follows a script's name
    "script": path    that runs instead of the command, and of these what is wanted:
    "folder": path    where it runs
    "hidden": [...]   libraries that cannot be imported
    "limit": bytes    no file may grow beyond it, as on a full disk
    "plain": true     without root's right to write where the mode forbids it
    "kill": seconds   kill -9 after so long

    [{"status": exit code or -9, "out": what it wrote to stdout, "err": to stderr,
      "seconds": ...}, ...]

`Commands` is the other end: a call with the arguments runs one job.
"""

import ctypes
import gc
import importlib
import json
import os
import resource
import runpy
import signal
import subprocess
import sys
import time
from typing import Any, Self

SLOW = (
    "OCP.STEPControl",
    "cadquery",
    "trimesh",
    "pyvista",
    "matplotlib.pyplot",
    "scipy.interpolate",
    "numba",
    "zarr",
    "bladegen.cli.commands",
    "bladegen.exports.build",
    "bladegen.exports.registry",
    "bladegen.formats.registry",
    "bladegen.formats.writing",
    "bladegen.measures.checks",
)
OVERRIDES = 1 << 1 | 1 << 2  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH
CAPABILITY_VERSION = 0x20080522


def without_overrides() -> None:
    """Take the right to pass over file modes from this process, as if it were not root's."""
    libc = ctypes.CDLL(None, use_errno=True)
    header = (ctypes.c_uint32 * 2)(CAPABILITY_VERSION, 0)
    sets = (ctypes.c_uint32 * 6)()  # effective, permitted, inheritable, twice 32 bits
    if libc.capget(header, sets):
        raise OSError(ctypes.get_errno(), "capget")
    sets[0] &= ~OVERRIDES
    sets[1] &= ~OVERRIDES
    if libc.capset(header, sets):
        raise OSError(ctypes.get_errno(), "capset")


def hide(library: str) -> None:
    """Make a library one that is not installed."""
    for name in [n for n in sys.modules if n.partition(".")[0] == library]:
        del sys.modules[name]
    sys.modules[library] = None  # type: ignore[assignment]


def run(job: dict[str, Any], out: int, error: int) -> None:
    """Be the command: never returns."""
    os.setsid()
    os.dup2(out, 1)
    os.dup2(error, 2)
    script = job.get("script")
    sys.argv = [script or "bladegen", *job["args"]]
    if "folder" in job:
        os.chdir(job["folder"])
    for library in job.get("hidden", ()):
        hide(library)
    if "limit" in job:
        sys.dont_write_bytecode = True  # what is compiled would stay, cut off
        resource.setrlimit(resource.RLIMIT_FSIZE, (job["limit"], job["limit"]))
    if job.get("plain"):
        without_overrides()
    from bladegen.cli.commands import main

    status = 70
    try:
        runpy.run_path(script, run_name="__main__") if script else main()
        status = 0
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 0 if end.code is None else 1
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def answered(jobs: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Run jobs at once and say how each ended."""
    running = []
    for job in jobs:
        out, error = (os.fdopen(os.memfd_create(name), "w+b") for name in ("stdout", "stderr"))
        start, process = time.monotonic(), os.fork()
        if process == 0:
            run(job, out.fileno(), error.fileno())
        running.append((job, process, start, out, error))
    answers = []
    for job, process, start, out, error in running:
        if "kill" in job:
            time.sleep(max(0.0, start + job["kill"] - time.monotonic()))
            os.killpg(process, signal.SIGKILL) if _leads(process) else os.kill(process, 9)
        _, status = os.waitpid(process, 0)
        answers.append(
            {
                "status": os.waitstatus_to_exitcode(status),
                "out": _read(out),
                "err": _read(error),
                "seconds": time.monotonic() - start,
            }
        )
    return answers


def _read(stream: Any) -> str:
    with stream:
        stream.seek(0)
        return stream.read().decode()


def _leads(process: int) -> bool:
    try:
        return os.getpgid(process) == process
    except ProcessLookupError:
        return False


class Commands:
    """The zygote's other end, for tests: the process and what it answers."""

    def __init__(self) -> None:
        environment = os.environ | {"OMP_NUM_THREADS": "1", "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        assert self.process.stdout is not None
        assert self.process.stdout.readline() == "ready\n"

    def together(self, *jobs: dict[str, Any]) -> list[dict[str, Any]]:
        """Run jobs at once."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps(jobs, default=str) + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def __call__(self, *args: Any, **how: Any) -> dict[str, Any]:
        return self.together({"args": list(map(str, args)), **how})[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        assert self.process.wait(60) == 0


def serve() -> None:
    """Import what is slow, then answer requests until stdin ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for name in SLOW:
        importlib.import_module(name)
    import bladegen

    bladegen.read("nrel5mw")  # with what its format's row imports
    gc.freeze()  # forks leave it where it is, and share its pages
    answers.write("ready\n")
    answers.flush()
    for line in sys.stdin:
        answers.write(json.dumps(answered(json.loads(line))) + "\n")
        answers.flush()


if __name__ == "__main__":
    serve()
