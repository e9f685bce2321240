#!/usr/bin/env bash
# Build sdist and wheel into dist/ and try the wheel as a user would: ./scripts/release.sh
# In a fresh virtual environment, away from the checkout, it builds the three blades.
set -euo pipefail
cd "$(dirname "$0")/.."
rm -rf dist/*.whl dist/*.tar.gz
.venv/bin/python -m hatchling build -d dist
.venv/bin/twine check --strict dist/*
room="$(mktemp -d)"
trap 'rm -rf "$room"' EXIT
.venv/bin/python -m venv "$room/venv"
"$room/venv/bin/pip" install --quiet --constraint locks/run.txt dist/*.whl
cd "$room"
venv/bin/bladegen --version
for blade in iea15mw nrel5mw dtu10mw; do
    venv/bin/bladegen build "$blade" -o out/
    venv/bin/bladegen check "out/$blade.step"
done
