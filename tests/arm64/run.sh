#!/usr/bin/env bash
# Tries the tarball for aarch64 under qemu, with Debian 13's libraries and its Mesa's lavapipe, against the
# program in build/release: what it prints, writes and draws. Exits with 1 if anything differs. Run `./run
# arm64` and `./run build` first. What was drawn stays in build/arm64-tried.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=tests/arm64/root.sh
. tests/arm64/root.sh
here=build/release/bin/binosplat there=build/arm64-tried/bin/binosplat tried=build/arm64-tried/tried
mkdir -p $tried/{here,there}
export XDG_CONFIG_HOME=$PWD/$tried XDG_CACHE_HOME=$PWD/$tried
checks=0 wrongs=0
try() { # WHAT COMMAND...
    checks=$((checks + 1))
    local what=$1 begin=$SECONDS
    shift
    if "$@"; then echo "$what: right, $((SECONDS - begin)) s"; else wrongs=$((wrongs + 1)) && echo "$what: WRONG"; fi
}
both() { # ARGUMENTS..., where %OUT is a folder of each
    "$here" "${@//%OUT/$tried/here}" | sed "s#$tried/here#%OUT#g" >$tried/here/said &&
        VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/lvp_icd.json arm64 "$there" "${@//%OUT/$tried/there}" | sed "s#$tried/there#%OUT#g" >$tried/there/said
}
saysTheSame() { both "$@" && diff $tried/{here,there}/said; }
writesTheSame() { # FILE ARGUMENTS...
    both "${@:2}" "%OUT/$1" && cmp $tried/{here,there}/"$1"
}
drawsAlike() { # PICTURE ARGUMENTS...
    both "${@:2}" && "$here" compare $tried/{here,there}/"$1" | awk '/^psnr/ { print "  " $2 " dB"; alike = $2 == "inf" || $2 >= 60 } END { exit !alike }'
}
# No library needs a newer glibc, or a libstdc++ newer than GCC 12's.
isOldEnough() {
    { find build/arm64-tried/{bin,lib} -type f -exec aarch64-linux-gnu-objdump -T {} + 2>/dev/null || true; } | grep -oE '\((GLIBC|GLIBCXX)_[0-9.]+\)' | tr -d '()' | sort -Vu |
        awk -F_ '{ last[$1] = $2 } END { print "  glibc " last["GLIBC"] ", libstdc++ " last["GLIBCXX"]; split(last["GLIBC"], c, "."); split(last["GLIBCXX"], x, ".")
            exit !(c[2] <= 35 && x[3] <= 30) }'
}

try "glibc 2.35 is enough" isOldEnough
try "info" saysTheSame info builtin:fence
# With this machine's version of the C library: sines and powers of a newer one differ in the last digits.
system=build/arm64-root try "a scene's bytes" writesTheSame atelier.ply scene atelier --splats 20000 --out
for kind in ply spz sog; do try "convert to $kind" writesTheSame "a.$kind" convert $tried/here/atelier.ply; done
try "render" drawsAlike picture/right.png render $tried/here/atelier.ply --size 64x64 --out %OUT/picture
printf 'size 256 256\nframes every 10\n' >$tried/ten.script
try "view in the simulated headset" drawsAlike seen/frame_000010.png view builtin:fence --simulate $tried/ten.script --frames 10 --load-first --out %OUT/seen
try "readers' suites" qemu-aarch64-static -L build/arm64-root build/arm64/bin/scene_tests
echo "$checks checks, $wrongs wrong"
((wrongs == 0))
