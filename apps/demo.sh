#!/bin/sh
# Install what is needed, build, and render the demo scene's views by day and by night.
# Usage: demo.sh [WIDTH] [FOLDER]   (default: 960 pixels wide, pictures in out/demo)
set -eu
cd "$(dirname "$0")/.."
root=$(pwd)
width="${1:-960}"
out="${2:-$root/out/demo}"
sh apps/install_packages.sh
cmake --preset release
cmake --build --preset release --target lightwalk
mkdir -p "$out"
cd apps/scenes/lodge
render() { # NAME VIEW LIGHT OPTIONS...
    name="$1" view="$2" light="$3"
    shift 3
    echo "$name"
    "$root/build/release/lightwalk" render -vf "views/$view.vf" -x "$width" -y "$((width * 3 / 4))" -ps 1 "$@" \
        -o "$out/$name.png" lodge.rad "$light.rad"
}
for view in living fireplace window dining mirror terrace rafters; do
    render "day-$view" "$view" day -av .35 .33 .30 -ds .3 --exposure auto
done
for view in living fireplace dining; do
    render "night-$view" "$view" night -av .05 .035 .02 --exposure auto
done
echo "The pictures are in $out"
