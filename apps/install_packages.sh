#!/bin/sh
# Install what Lightwalk is built from, on Debian 12 as root or with sudo, and the packages given as arguments. Does
# nothing when all is there.
set -eu
packages="g++ cmake ninja-build libtbb-dev libembree-dev libopenimageio-dev nlohmann-json3-dev libtinygltf-dev doctest-dev
libboost-dev libboost-context-dev libturbojpeg0-dev libbenchmark-dev libopenmpi-dev openmpi-bin libzstd-dev zlib1g-dev libxxhash-dev libpugixml-dev python3 python3-numpy $*"
missing=""
for package in $packages; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0
as_root=""
[ "$(id -u)" -eq 0 ] || as_root="sudo"
echo "Installing:$missing"
$as_root apt-get update -qq
# shellcheck disable=SC2086  # a list of words
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null
