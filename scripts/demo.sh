#!/usr/bin/env bash
# From a bare Debian 12 to a checked space-time hull: installs what is missing, builds, runs the paper's rotating
# ellipsoid (coarsest mesh) and checks the result.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-deps.sh
scripts/build.sh release -DSLABHULL_TESTS=OFF -DSLABHULL_UNITY=ON
program=build/release/tools/slabhull

echo
echo '$ slabhull build examples/ellipsoid.toml'
$program build examples/ellipsoid.toml
echo
echo '$ slabhull check out/ellipsoid/slab_0000.vtu'
$program check out/ellipsoid/slab_0000.vtu
cat <<'END'

The hull of one slab is in out/ellipsoid:
  slab_0000.vtu   for ParaView: 3D cells with the time "t", ids, tracks, regions, patches, layers and neighbours
  slab_0000.msh   the same for Gmsh
  cap_0001.vtu    the terminating cap: the spatial mesh at t = 1
  report.json     counts, measures, quality, seconds by stage, peak memory
END
