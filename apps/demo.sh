#!/bin/sh
# Install what is needed, build, and walk through the demo scene in a browser, or render its views.
# Usage: demo.sh [OPTIONS...]                       walk: open the printed address; options of `lightwalk walk`
#        demo.sh --pictures [WIDTH] [FOLDER]        by day and in the evening (640 pixels wide, in out/demo)
set -eu
cd "$(dirname "$0")/.."
root=$(pwd)
sh apps/install_packages.sh
cmake --preset release
cmake --build --preset release --target lightwalk
if [ "${1:-}" != --pictures ]; then
    cd apps/scenes/lodge
    echo "Open this address in a browser; Ctrl-C ends the walk:"
    exec "$root/build/release/lightwalk" walk -vf views/living.vf -vf views/window.vf -vf views/dining.vf \
        -vf views/fireplace.vf -vf views/terrace.vf -ab 1 -aa .25 -ad 256 -as 64 -ar 384 -av .2 .2 .19 -ds .3 "$@" \
        lodge.rad day.rad
fi
width="${2:-640}"
out="${3:-$root/out/demo}"
mkdir -p "$out"
cd apps/scenes/lodge
rm -f "$out"/day*.amb "$out"/night*.amb
# All views of one light share its ambient file. -dj with several samples a pixel: soft shadows without steps.
# Indirect values reach at least -aa/-ar of the scene's size, here 800 m with its hills: half a metre indoors, less
# than that under the eaves. Terraces are seen with finer values, which have files of their own.
render() { # LIGHT VIEW OPTIONS...
    light="$1" view="$2"
    shift 2
    echo "$light-$view"
    "$root/build/release/lightwalk" render -vf "views/$view.vf" -x "$width" -y "$((width * 3 / 4))" --samples 6 \
        -ab 2 -aa .25 -ad 256 -as 64 -ar 384 -dj .7 -af "$out/$light.amb" "$@" \
        -o "$out/$light-$view.png" lodge.rad "$light.rad"
}
for view in living window dining; do
    render day "$view" -av .2 .2 .19 -ds .3
done
render day terrace -av .2 .2 .19 -ds .3 -ar 1024 -af "$out/day-terrace.amb"
for view in living fireplace; do
    render night "$view" -av .004 .003 .002 -ds .08
done
render night terrace -av .004 .003 .002 -ds .08 -ar 1024 -af "$out/night-terrace.amb"
rm -f "$out"/day*.amb "$out"/night*.amb
echo "The pictures are in $out"
