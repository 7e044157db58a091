#!/usr/bin/env bash
# Makes the Debian packages in build/packages, lets lintian look at them, and tries them in a bare Debian.
#   scripts/packages.sh              make, look, try
#   scripts/packages.sh --try FOLDER install the packages of a folder on this machine and use them: in the bare Debian
set -euo pipefail
cd "$(dirname "$0")/.."

try_packages() { # FOLDER
    local begin=$SECONDS scratch
    apt-get install -y -qq "$1"/slabhull_*.deb >/dev/null 2>&1
    scratch=$(mktemp -d)
    cp -r /usr/share/doc/slabhull/examples "$scratch"
    cd "$scratch"
    slabhull new examples/sphere.off --out sphere.toml
    slabhull build sphere.toml --dry-run
    slabhull build examples/room.toml --quiet
    slabhull check out/room/slab_0000.vtu >/dev/null
    slabhull view out/room/slab_0000.vtu --out room.html
    gzip -t /usr/share/man/man1/slabhull-build.1.gz
    echo "== from the package to the first page: $((SECONDS - begin)) s"
    apt-get install -y -qq "$1"/python3-slabhull_*.deb >/dev/null 2>&1
    /usr/bin/python3 -c 'import slabhull; print("== the module of Python is", slabhull.__version__)'
    apt-get install -y -qq "$1"/libslabhull-dev_*.deb cmake g++ >/dev/null 2>&1
    cmake -S "$OLDPWD/tests/consumer" -B consumer >/dev/null
    cmake --build consumer >/dev/null
    echo "== a program was built on the library package"
}

if [[ ${1:-} == --try ]]; then
    try_packages "$2"
    exit
fi
scripts/install-deps.sh --test
cmake -S . -B build/package -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DSLABHULL_TESTS=OFF \
    -DSLABHULL_UNITY=ON >/dev/null
cmake --build build/package
rm -rf build/packages
(cd build/package && cpack -B ../packages >/dev/null)
rm -rf build/packages/_CPack_Packages
command -v lintian >/dev/null && lintian --allow-root --fail-on error build/packages/*.deb
scripts/bare.sh 'bash scripts/packages.sh --try /repository/build/packages'
