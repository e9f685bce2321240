#!/usr/bin/env bash
# Set bladegen up in .venv: ./scripts/setup.sh [EXTRA]
# Finds out which shared libraries are missing and installs them where it may; makes a virtual
# environment; installs bladegen with the extra. A second run with nothing changed is quick.
set -euo pipefail
cd "$(dirname "$0")/.."
extra="${1:-}"

fail() {
    printf 'setup: %s\n' "$1" >&2
    exit 1
}

find_python() {
    local name
    for name in "${PYTHON:-}" python3.14 python3.13 python3.12 python3.11 python3; do
        if [ -n "$name" ] && command -v "$name" >/dev/null 2>&1 &&
            "$name" -c 'import ensurepip, sys, venv; sys.exit(not (3, 11) <= sys.version_info < (3, 15))' 2>/dev/null; then
            command -v "$name"
            return
        fi
    done
    fail "needs Python 3.11 to 3.14 with venv; on Debian: apt-get install python3 python3-venv"
}

# Prints the Debian packages of the shared libraries that cannot be loaded.
missing_packages() {
    "$1" - <<'PY'
import ctypes

LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libX11.so.6": "libx11-6",
    "libXrender.so.1": "libxrender1",
    "libEGL.so.1": "libegl1",
    "libEGL_mesa.so.0": "libegl-mesa0",
    "libexpat.so.1": "libexpat1",
}


def loads(name):
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


print(*sorted({package for name, package in LIBRARIES.items() if not loads(name)}))
PY
}

# Installs Debian packages, or says what is missing: install_packages PACKAGES WHAT
install_packages() {
    local packages="$1" what="$2" sudo=""
    local line="apt-get install -y --no-install-recommends $packages"
    if ! command -v apt-get >/dev/null 2>&1; then
        fail "missing: $what; on Debian: $line"
    fi
    if [ "$(id -u)" -ne 0 ]; then
        sudo -n true 2>/dev/null || fail "missing: $what; type: sudo $line"
        sudo="sudo -n"
    fi
    printf 'setup: installing %s\n' "$packages"
    $sudo apt-get update -qq || true
    # shellcheck disable=SC2086  # the packages are words
    DEBIAN_FRONTEND=noninteractive $sudo $line >/dev/null || fail "could not: $line"
}

install_libraries() {
    local packages
    packages="$(missing_packages "$1")"
    [ -n "$packages" ] || return 0
    install_packages "$packages" "shared libraries"
    packages="$(missing_packages "$1")"
    [ -z "$packages" ] || fail "still missing after the install: $packages"
}

find_browser() {
    command -v chromium || command -v chromium-browser || command -v google-chrome
}

python="$(find_python)"
install_libraries "$python"
# the tests look at the studio in a real browser, and run shell models
case "$extra" in
    test | dev)
        find_browser >/dev/null ||
            install_packages chromium "Chromium, which the tests of the studio need"
        find_browser >/dev/null || fail "no Chromium after its install"
        command -v ccx >/dev/null ||
            install_packages calculix-ccx "CalculiX, which runs the shell models of the tests"
        command -v ccx >/dev/null || fail "no CalculiX after its install"
        ;;
esac
# pip comes last: without it an earlier run was broken off
[ -x .venv/bin/pip ] || "$python" -m venv --clear .venv
# What was installed with an extra serves without it too, and "dev" holds "test".
is_done() {
    local stamp
    for stamp in "$@"; do
        if [ -f "$stamp" ] && [ "$stamp" -nt pyproject.toml ] && [ "$stamp" -nt locks/dev.txt ]; then
            return 0
        fi
    done
    return 1
}

stamp=".venv/.bladegen-${extra:-plain}"
case "$extra" in
    "") others=(.venv/.bladegen-*) ;;
    test) others=(.venv/.bladegen-dev) ;;
    *) others=() ;;
esac
if ! is_done "$stamp" ${others[@]+"${others[@]}"}; then
    printf 'setup: installing bladegen into .venv (about two minutes and 2 GB)\n'
    # Developers and CI use the versions that were tested; users, and `make demo`, the newest allowed.
    # The tests compile what they import; a user's commands begin quickly, all is compiled for them.
    options=()
    [ -z "$extra" ] || options=(--no-compile --constraint locks/dev.txt)
    .venv/bin/python -m pip install --quiet --disable-pip-version-check \
        ${options[@]+"${options[@]}"} --editable ".${extra:+[$extra]}"
    touch "$stamp"
fi
