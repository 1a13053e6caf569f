#!/usr/bin/env bash
# Tries the package for Windows under Wine, on Mesa's lavapipe, from a folder with a space and an umlaut: what
# it prints, draws and reports about mistakes must equal the Linux program's. Exits with 1 if anything
# differs.
#   tests/windows/run.sh [PART...]     of: info render path bench view trouble hello; all, where none is named
# First run third_party/windows.sh (the package), `./run build` (the Linux program) and, for the part "hello",
# third_party/windows/libraries.sh hello.
# What was drawn stays in build/windows-tried, what Wine needs in build/windows-wine (or WINEPREFIX).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
here=$PWD/tests/windows
build=$PWD/build
fence=builtin:fence
modes=(mono two-pass shared reproject paper predicted alternate temporal)
least_db=60

# shellcheck source=tests/windows/wine.sh
. tests/windows/wine.sh
linux_program=$build/release/bin/binosplat
package=$(find "$build/windows" -maxdepth 1 -name 'binosplat-*-windows-x64.zip' -printf '%T@ %p\n' | sort -n | tail -n 1 | cut -d' ' -f2-)
[[ -n $package && -x $linux_program ]] || {
    echo "tests/windows/run.sh: no package in build/windows or no program in build/release; run third_party/windows.sh and ./run build" >&2
    exit 1
}
tried=$build/windows-tried
place="$tried/Räume für Gäste"
program="$place/Das Programm ü"
rm -rf "$tried"
mkdir -p "$program" "$place/Linux" "$place/Windows" "$tried/plain"
unzip -q "$package" -d "$program"
export XDG_CONFIG_HOME=$tried/config XDG_CACHE_HOME=$tried/cache
export BINOSPLAT_FONT=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
cd "$place"

checks=0 wrongs=0
right() { checks=$((checks + 1)) && echo "$*"; }
wrong() {
    checks=$((checks + 1)) wrongs=$((wrongs + 1))
    echo "DIFFERS: $*"
}
linux() { timeout 600 "$linux_program" "$@"; }
windows() { timeout 600 wine "$program/binosplat.exe" "$@"; }
# Both programs' output, each in a file of its own, without carriage returns; exit codes in $code_linux and
# $code_windows.
both() { # ARGUMENTS..., where %OUT is Linux or Windows
    local code=0
    linux "${@//%OUT/Linux}" >Linux/said 2>Linux/complained || code=$?
    code_linux=$code code=0
    windows "${@//%OUT/Windows}" >Windows/said 2>Windows/complained || code=$?
    code_windows=$code
    sed -i 's/\r$//' Windows/{said,complained}
    sed -i 's/Linux/%OUT/g' Linux/{said,complained}
    sed -i 's/Windows/%OUT/g' Windows/{said,complained}
}
bothSucceed() {
    both "$@"
    [[ $code_linux = 0 && $code_windows = 0 ]] && return
    wrong "$*: exit codes $code_linux and $code_windows: $(cat Linux/complained) / $(cat Windows/complained)"
    return 1
}
# The lowest PSNR between Linux's pictures and those of the same names. A missing picture counts as 0 dB.
worst_db() { # FOLDER PATTERN
    local picture
    find "Linux/$1" -name "$2" | sort | while read -r picture; do
        "$linux_program" compare "$picture" "Windows/${picture#Linux/}" 2>/dev/null | awk '/^psnr /{print $2; found = 1} END {exit !found}' || echo 0
    done | sort -g | head -n 1
}
pictures() { # WHAT FOLDER PATTERN
    local db
    db=$(worst_db "$2" "$3")
    if awk -v db="${db:-0}" -v least="$least_db" 'BEGIN { exit !(db == "inf" || db >= least) }'; then
        right "$1: $(find "Linux/$2" -name "$3" | wc -l) pictures, at least $db dB"
    else
        wrong "$1: a picture has ${db:-0} dB only, must be $least_db at least"
    fi
}
# For the loader: a program run by an administrator, as Wine's user is, ignores XR_RUNTIME_JSON.
registerRuntime() {
    wine reg add 'HKLM\Software\Khronos\OpenXR\1' /v ActiveRuntime /t REG_SZ /d "$(winepath -w "$1")" /f >/dev/null
}
forgetRuntime() { wine reg delete 'HKLM\Software\Khronos\OpenXR\1' /v ActiveRuntime /f >/dev/null 2>&1 || true; }

makeScenes() {
    linux scene atelier --splats 20000 --out Zimmer.ply >/dev/null
    linux convert Zimmer.ply "Küche nebenan.sog" >/dev/null
    linux convert Zimmer.ply 房間.spz >/dev/null
    head -c 40000 Zimmer.ply >halb.ply
    printf '%s\n' time_s,x,y,z,qx,qy,qz,qw 0,0,0,0,0,0,0,1 0.011,0.004,0,0,0,0.002,0,1 0.022,0.008,0.001,0,0,0.004,0,1 0.033,0.012,0.002,0.001,0,0.006,0,1 >Weg.csv
    scenes=(Zimmer.ply "Küche nebenan.sog" 房間.spz)
}

tryInfo() {
    local scene
    # The LGPL requires it.
    if compgen -G "$program/licences/fribidi/source/*.orig.tar.*" >/dev/null; then right "FriBidi's source is there"; else wrong "no source of FriBidi"; fi
    for scene in "${scenes[@]}" "$fence"; do
        bothSucceed info "$scene" || continue
        if diff Linux/said Windows/said; then right "info $scene: the same words"; else wrong "info $scene"; fi
    done
    # What it writes looks like what the Linux program writes; the bytes differ, since logarithms of the two C
    # libraries do.
    local file system
    for file in "Zimmer.ply über.spz" "Zimmer.ply über.sog" "房間.spz über.ply"; do
        bothSucceed convert "${file% *}" "%OUT/${file#* }" || continue
        for system in Linux Windows; do linux render "$system/${file#* }" --size 320x240 --mode mono --out "$system/aus ${file#* }" >/dev/null; done
        pictures "convert to ${file#* }" "aus ${file#* }" mono.exr
    done
}

tryRender() {
    local scene mode
    for scene in "${scenes[@]}"; do
        for mode in "${modes[@]}"; do
            bothSucceed render "$scene" --size 320x240 --mode "$mode" --out "%OUT/$mode von $scene" || continue
            pictures "render $scene --mode $mode" "$mode von $scene" '[lmr]*.exr'
            "$here/same_counters.py" {Linux,Windows}/"$mode von $scene/report.json" || wrong "render $scene --mode $mode: counters"
        done
    done
}

tryPath() {
    local mode
    for mode in predicted alternate temporal; do
        bothSucceed render Zimmer.ply --size 320x240 --mode "$mode" --path Weg.csv --out "%OUT/Weg $mode" || continue
        pictures "render --path --mode $mode" "Weg $mode" 'frame_*t.png'
    done
}

tryBench() {
    cat >winzig.toml <<TOML
[bench]
scenes = ["$fence"]
modes = ["mono", "two-pass", "shared", "reproject", "paper", "predicted", "alternate", "temporal"]
scores = ["psnr"]
warm-up = 0
repeats = 1

[[series]]
name = "winzig"
sizes = ["128x128"]
TOML
    bothSucceed bench --config winzig.toml --out "%OUT/Messung" || return 0
    if "$here/same_bench.py" {Linux,Windows}/Messung; then right "bench: the same rows and scores"; else wrong "bench"; fi
}

# The log of every frame, and the pictures.
seen() { # NAME SCRIPT ARGUMENTS...
    local name=$1 script=$2
    shift 2
    bothSucceed view "$fence" --load-first --simulate "$script" --out "%OUT/$name" "$@" || return 0
    if python3 "$program/compare_frame_logs.py" {Linux,Windows}/"$name"; then right "view $name: the same log"; else wrong "view $name: its log"; fi
    pictures "view $name" "$name" 'frame_*.png'
}
tryView() {
    registerRuntime "$program/simulated_runtime.json"
    cat >Spaziergang.script <<'SCRIPT'
rate 90
size 256 256
head 0.0 position 0.0 1.60  0.0 turn 0 0
head 0.7 position 0.1 1.62 -0.2 turn 8 -3
frames every 19
SCRIPT
    # Points at *Balanced* and clicks; points at *Quit* and does not click; then both hands grab the scene,
    # turn it and enlarge it.
    cat >Griffe.script <<'SCRIPT'
rate 90
size 384 384
controller left  0.0 position -0.2 1.2 -0.35
controller right 0.0 position 0.2 1.2 -0.35 look -0.45 1.697 -0.92
press right trigger 0.15 0.25
controller right 0.3 position 0.2 1.2 -0.35 look -0.45 1.697 -0.92
controller right 0.4 position 0.2 1.2 -0.35 look -0.289 1.765 -1.010
controller right 0.5 position 0.2 1.2 -0.35 turn 0 0
controller left  0.5 position -0.2 1.2 -0.35
press left  squeeze 0.55 0.85
press right squeeze 0.55 0.85
controller left  0.8 position -0.3 1.25 -0.30
controller right 0.8 position 0.35 1.15 -0.45 turn 10 0
frames every 9
at 1.0 exit
SCRIPT
    local mode name
    for mode in "${modes[@]}"; do seen "gesehen $mode" Spaziergang.script --mode "$mode" --frames 60; done
    seen "Griffe" Griffe.script
    for name in panel hands; do seen "$name" "$program/configs/simulated/$name.script"; done
    forgetRuntime
}

# Both end with this code and the same line on standard error, except for what the systems call things, in
# $systems.
systems=
refused() { # CODE ARGUMENTS...
    local code=$1
    shift
    both "$@"
    if [[ $code_linux = "$code" && $code_windows = "$code" ]] && { [[ -n $systems ]] || diff Linux/complained Windows/complained; } &&
        [[ $(wc -l <Windows/complained) = 1 && $(cat Windows/complained) =~ ^binosplat:\ .*$systems ]]; then
        right "$*: $code, $(cat Windows/complained)"
    else
        wrong "$*: exit codes $code_linux and $code_windows, must be $code: $(cat Linux/complained) / $(cat Windows/complained)"
    fi
}
tryTrouble() {
    printf '[stereo]\nmargin = "breit"\n' >falsch.toml
    echo "kein PLY" >Müll.ply
    mkdir -p "leerer Ordner"
    refused 1 info "nicht da ü.ply"
    refused 1 info halb.ply
    refused 1 info Müll.ply
    refused 1 info "leerer Ordner"
    refused 1 render halb.ply --out "%OUT/nichts"
    refused 1 render "$fence" --config falsch.toml --out "%OUT/nichts"
    refused 1 render "$fence" --config fehlt.toml --out "%OUT/nichts"
    refused 1 convert Zimmer.ply "%OUT/kein Ordner/x.spz"
    refused 1 view "$fence" --simulate fehlt.script
    refused 1 render "$fence" --mode dreifach --out "%OUT/nichts"
    refused 1 "nicht da ü.ply"
    refused 2 Zimmer.ply halb.ply
    refused 2 rendre "$fence"
    refused 2 render "$fence"
    # Wine has no Vulkan without a display.
    local display=$DISPLAY
    export DISPLAY='' VK_ICD_FILENAMES=/nowhere.json
    systems="Vulkan.*install" refused 3 render "$fence" --out "%OUT/nichts"
    export DISPLAY=$display
    unset VK_ICD_FILENAMES
    forgetRuntime
    systems='without administrator rights, or set that value to' XR_RUNTIME_JSON=/nowhere.json refused 3 view "$fence"
    # A path that may be too long.
    local code=0 long
    long=Windows/$(printf '%0240d' 0)
    windows render "$fence" --size 64x64 --mode mono --out "$long" >/dev/null 2>Windows/complained || code=$?
    if [[ $code = 0 || $code = 1 && $(cat Windows/complained) = *'path may be too long'* ]] && ! compgen -G "$long/.binosplat-*" >/dev/null; then
        right "a folder of 240 letters: $code, $(cat Windows/complained)"
    else
        wrong "a folder of 240 letters: exit code $code: $(cat Windows/complained)"
    fi
    # Ctrl-C in the middle.
    code=0
    wine "$program/binosplat.exe" render Zimmer.ply --size 1024x1024 --path Weg.csv --out Windows/nichts 2>Windows/complained &
    sleep 3
    kill -INT $!
    wait $! || code=$?
    if [[ $code = 130 ]] && grep -q 'stopped by SIGINT, nothing was written' Windows/complained; then
        right "Ctrl-C: 130, $(cat Windows/complained)"
    else
        wrong "Ctrl-C: exit code $code: $(cat Windows/complained)"
    fi
    if [[ -e Linux/nichts || -e Windows/nichts ]]; then wrong "something was left of what was refused"; else right "nothing was left of what was refused"; fi
}

# Khronos's example program on the simulated runtime. Its loader cannot read names outside the system's code
# page, so it starts from a plain folder.
tryHello() {
    local hello=$build/windows-prefix/installed/bin/hello_xr.exe code=0
    [[ -e $hello ]] || { wrong "hello_xr.exe is missing: third_party/windows/libraries.sh hello"; return; }
    cp "$program"/{binosplat_simulated_runtime.dll,simulated_runtime.json} "$hello" "$tried/plain"
    printf 'size 256 256\nframes every 20\nat 0.5 exit\n' >"$tried/plain/hello.script"
    registerRuntime "$tried/plain/simulated_runtime.json"
    # It ends when its input does, so that is a pipe that stays open.
    rm -f "$tried/plain/keys"
    mkfifo "$tried/plain/keys"
    (
        cd "$tried/plain"
        SIMULATED_OPENXR_SCRIPT=hello.script SIMULATED_OPENXR_OUT=seen timeout 120 wine hello_xr.exe -g Vulkan2 0<>keys >said 2>&1
    ) || code=$?
    forgetRuntime
    if [[ $code = 0 ]] && grep -q 'state FOCUSED' "$tried/plain/seen/frames.jsonl" && [[ -s $tried/plain/seen/frame_000040.png ]]; then
        right "hello_xr.exe: FOCUSED, pictures, exit code 0"
    else
        wrong "hello_xr.exe: exit code $code: $(tail -n 3 "$tried/plain/said")"
    fi
}

parts=("$@")
((${#parts[@]} > 0)) || parts=(info render path bench view trouble hello)
makeScenes
for part in "${parts[@]}"; do
    begin=$SECONDS
    case $part in
        info | render | path | bench | view | trouble | hello) "try${part^}" ;;
        *)
            echo "tests/windows/run.sh: $part is none of info, render, path, bench, view, trouble, hello" >&2
            exit 2
            ;;
    esac
    echo "-- $part: $((SECONDS - begin)) s"
done
echo "$checks checks, $wrongs differ"
((wrongs == 0))
