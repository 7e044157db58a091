#!/usr/bin/env bash
# Installs the Debian packages of scripts/packages.txt that are missing. Asks for root only if one is.
#   scripts/install-deps.sh          what the build needs
#   scripts/install-deps.sh --test   what the tests need, too
set -euo pipefail
list=$(dirname "$0")/packages.txt
want=${1:-}

wanted_packages() {
    awk -v all="$want" '/^# ---/ { test = /: test$/ } !/^#/ && NF && (!test || all == "--test") { print $1 }' "$list"
}

missing=()
for package in $(wanted_packages); do
    status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
    [[ $status == "install ok installed" ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    exit 0
fi

echo "Installing: ${missing[*]}" >&2
root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
        echo "Run as root: apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    root=(sudo)
fi
"${root[@]}" apt-get update -qq
"${root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
