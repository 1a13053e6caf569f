#!/usr/bin/env bash
# Tries the levels of detail that `binosplat convert` writes with PlayCanvas's own readers, from npm. Run
# `./run build` first. Needs node, npm and a network; the packages and the scene go into build/playcanvas.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=$PWD/build/playcanvas binosplat=$PWD/build/release/bin/binosplat reader=$PWD/tests/playcanvas/read_levels.mjs
mkdir -p "$folder"
cd "$folder"
npm install --no-audit --no-fund --ignore-scripts --loglevel=error @playcanvas/splat-transform@2.7.1 playcanvas@2.23.3
rm -rf levels
"$binosplat" scene atelier --splats 60000 --out atelier.ply
"$binosplat" convert atelier.ply levels/lod-meta.json --levels 4 --chunk-splats 16384
node "$reader" levels
