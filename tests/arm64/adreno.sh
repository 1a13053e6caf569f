#!/usr/bin/env bash
# Compiles the kernels of a frame of temporal for Adrenos that this machine does not have: Turnip under qemu,
# on a stand-in for the kernel's driver that executes nothing. Prints their statistics, then a table
# (docs/results/gpu.md); exits with 1 if registers spill. Run `./run arm64` first.
#   tests/arm64/adreno.sh [FILTER]     of `binosplat kernels --filter`, in place of these kernels
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=tests/arm64/root.sh
. tests/arm64/root.sh
# Kernels for 3D Gaussians, for chosen tiles, with pictures in half precision.
kernels='cull kSplatKind=1 kMasked=1 kInPages=0|compact kInPages=0|sort_|project .*kMasked=1 kSplatKind=1 kPlaced=0|bin kSplatKind=1'
kernels+='|tile_ranges kMasked=1 kHalfColours=1|rasterize .*kHalfColours=1 kSplatKind=1 .*kMasked=1 kHistory=1'
kernels+='|warp_history kHalfColours=1 kHiddenTiles=1 kWholeBlocks=1|warp_pixels kHalfColours=1 kHiddenTiles=1'
kernels+='|price kFoveated=0 kHistory=1|select kPredicted=1 kHistory=1'
filter=${1:-"^($kernels)"}
export VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/freedreno_icd.json
tables=() spills=0
for gpu in 740 750; do
    out=build/arm64-tried/adreno$gpu
    FD_GPU_ID=$gpu qemu-aarch64-static -L build/arm64-mesa -E LD_PRELOAD=/usr/lib/aarch64-linux-gnu/libfreedreno_noop_drm_shim.so \
        build/arm64-tried/bin/binosplat kernels --filter "$filter" --out $out
    tables+=("adreno$gpu=$out/kernels.json")
    ! grep -E '"(STP|LDP) Count": [1-9]' $out/kernels.json || spills=1
done
python3 docs/results/gpu_table.py "${tables[@]}"
((spills == 0))
