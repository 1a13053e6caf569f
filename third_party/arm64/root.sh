#!/usr/bin/env bash
# Unpacks Debian's arm64 packages into a folder that the cross compiler takes for a system: headers and
# libraries, of the release and the mirror that this machine has. Nothing is installed here. A folder that has
# these packages already is left alone.
#   third_party/arm64/root.sh FOLDER SUITE PACKAGE...
set -euo pipefail
folder=$1 suite=$2
shift 2
stamp="$(sha256sum "${BASH_SOURCE[0]}" | cut -d' ' -f1) $suite $*"
[[ ! -f $folder/stamp || $(cat "$folder/stamp") != "$stamp" ]] || exit 0
rm -rf "$folder"
mkdir -p "$folder"/apt/{lists,archives}/partial "$folder"/usr/{bin,lib,sbin}
folder=$(cd "$folder" && pwd)
for name in bin lib sbin; do ln -s "usr/$name" "$folder/$name"; done
trap 'status=$?; [[ $status = 0 ]] || { tail -n 20 "$folder/log"; echo "third_party/arm64/root.sh: failed; all of it is in $folder/log"; } >&2' EXIT

mirror=$(apt-cache policy base-files | sed -n 's/.* \(https\?:[^ ]*\) .*/\1/p' | grep -v security | head -n 1)
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" >"$folder/apt/sources.list"
touch "$folder/apt/status"
apt() { # with lists of its own, and as if nothing were installed
    apt-get -q -y -o Dir::Etc::SourceList="$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$folder/apt/lists" \
        -o Dir::State::status="$folder/apt/status" -o Dir::Cache="$folder/apt" -o Dir::Cache::archives="$folder/apt/archives" \
        -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Install-Recommends=false -o APT::Sandbox::User="$(id -un)" \
        -o Debug::NoLocking=true "$@" >>"$folder/log" 2>&1
}
apt update
apt --download-only install "$@"
for package in "$folder"/apt/archives/*.deb; do dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink -C "$folder"; done
# What links name from the top.
find "$folder" -lname '/*' -print0 | while IFS= read -r -d '' link; do
    ln -snf --relative "$folder$(readlink "$link")" "$link"
done
rm -r "$folder/apt"
echo "$stamp" >"$folder/stamp"
