#!/usr/bin/env bash
# Print a page on the licences of all that bladegen needs to run: the packages of locks/run.txt.
set -euo pipefail
cd "$(dirname "$0")/.."
cat <<'HEAD'
# Licences of what bladegen needs

All packages of `locks/run.txt`, from their own metadata (`make licences`). bladegen itself is
Apache-2.0; OCCT, inside cadquery-ocp, is LGPL-2.1 with an exception and linked dynamically.

Figures of the bundled blades are others' (the head of each file in `blades/` names source, version and licence):
IEA 15 MW, its structure included, Apache-2.0; NREL 5 MW BSD-3-Clause, its structure (WISDEM) Apache-2.0; DTU 10 MW
Apache-2.0 and LGPL-3.0.

HEAD
# shellcheck disable=SC2046  # the names are words
.venv/bin/pip-licenses --from=mixed --format=markdown --order=name \
    --packages $(sed 's/[=; ].*//' locks/run.txt | sort -u)
