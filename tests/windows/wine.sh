# Sourced by the scripts of this folder: Wine with its own screen and prefix. Sets WINEPREFIX and DISPLAY.
# shellcheck shell=bash
# One script at a time: when one ends, everything in its prefix ends.
for tool in wine Xvfb unzip python3; do
    command -v "$tool" >/dev/null || {
        echo "$0: $tool is missing; install wine64 wine xvfb unzip python3" >&2
        exit 1
    }
done
export WINEPREFIX=${WINEPREFIX:-$PWD/build/windows-wine} WINEDEBUG=${WINEDEBUG:--all} LC_ALL=C.UTF-8
mkdir -p "$WINEPREFIX"
# Wine supports Vulkan only with a screen.
exec {wine_screen}< <(exec Xvfb -displayfd 1 -screen 0 1280x1024x24 -nolisten tcp 2>/dev/null)
wine_screen_process=$!
trap 'wineserver -k || true; kill "$wine_screen_process"' EXIT
read -r -u "$wine_screen" wine_display
export DISPLAY=:$wine_display
[[ -e $WINEPREFIX/system.reg ]] || wineboot --init >/dev/null 2>&1
