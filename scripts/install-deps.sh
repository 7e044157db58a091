#!/usr/bin/env bash
# Installs the Debian packages of scripts/packages.txt that are missing. Asks for root only if one is.
#   scripts/install-deps.sh          what the build needs
#   scripts/install-deps.sh --test   what the tests need, too
#   scripts/install-deps.sh --bare   what scripts/bare.sh needs
#   scripts/install-deps.sh --lint   what scripts/lint.sh needs beside what the tests need
set -euo pipefail
list=$(dirname "$0")/packages.txt
want=${1:-}

packages_under() { # headings that end so
    awk -v heading="$1" '/^# ---/ { take = $0 ~ heading } !/^#/ && NF && take { print $1 }' "$list"
}

install_missing() {
    local missing=() package status root=()
    for package in "$@"; do
        status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
        [[ $status == "install ok installed" ]] || missing+=("$package")
    done
    if ((${#missing[@]} == 0)); then
        return 0
    fi
    echo "Installing: ${missing[*]}" >&2
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "Run as root: apt-get install --no-install-recommends ${missing[*]}" >&2
            return 1
        fi
        root=(sudo)
    fi
    if [[ ! -v updated ]]; then
        "${root[@]}" apt-get update -qq || return 1
        updated=yes
    fi
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

if [[ $want == --bare || $want == --lint ]]; then
    install_missing $(packages_under ": ${want#--}\$")
    exit
fi
needed=$(packages_under ' ---$')
if [[ $want == --test ]]; then
    needed+=" $(packages_under ': test$')"
fi
install_missing $needed
if [[ $want == --test ]]; then
    install_missing $(packages_under ': test, if it can be had$') ||
        echo "Without a browser; the test that draws a page leaves that part out." >&2
fi
