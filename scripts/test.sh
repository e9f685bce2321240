#!/usr/bin/env bash
# Run the tests in .venv: ./scripts/test.sh [PYTEST OPTIONS]
# What else is asked of a run is looked at only once all tests passed, so that one failure stays
# one: tests write into their temporary folders, so the checkout is as it was; and with COVER=1, as
# in .ci/run, they cover 95 %.  Counting lines takes a quarter of the processor's time.
set -euo pipefail
cd "$(dirname "$0")/.."
# written by the tools that run the tests
caches='^!! (\.venv/|\.coverage.*|\.(hypothesis|mypy_cache|pytest_cache|ruff_cache)/|(.*/)?__pycache__/)$'

# Prints what differs from the commit; nothing outside a checkout, as in an unpacked sdist.
state() {
    if [ "$(git rev-parse --show-toplevel 2>/dev/null)" = "$PWD" ]; then
        git status --porcelain --ignored | { grep -vE "$caches" || true; }
        printf "changes %s\n" "$(git diff HEAD | git hash-object --stdin)"
    fi
}

# a library is compiled once then, and not by each of some hundred processes
unset PYTHONDONTWRITEBYTECODE
before="$(state)"
# compiled loops are kept on the disk: made here once, and not by every process that counts its lines
for kind in families derivatives; do .venv/bin/python scripts/warm.py "$kind" & done
wait
# three on two cores: tests wait for browsers and other processes, too
# worksteal keeps a module's tests, and what they share, in one process as far as it can
.venv/bin/python -m pytest -n "${JOBS:-3}" --dist worksteal ${COVER:+--cov --cov-report=} "$@"
after="$(state)"
if [ "$before" != "$after" ]; then
    printf 'test: the checkout was changed while the tests ran:\n' >&2
    diff <(printf '%s\n' "$before") <(printf '%s\n' "$after") | grep '^[<>]' >&2
    exit 1
fi
[ -z "${COVER:-}" ] || .venv/bin/coverage report --fail-under=95
