#!/usr/bin/env bash
# Makes the pictures of the README again, with the program itself, in docs/pictures.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
surfaces=$root/examples/surfaces
out=$root/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$root/run" design "$surfaces/kidney_dome.obj" -o "$work/kidney.auxshell" --triangles 600 >/dev/null
"$root/run" info "$work/kidney.auxshell" --png "$work/kidney" >/dev/null
"$root/run" design "$surfaces/valley_roof.obj" -o "$work/valley.auxshell" --triangles 600 --project >/dev/null
"$root/run" info "$work/valley.auxshell" --png "$work/valley" >/dev/null
"$root/run" check "$surfaces/valley_roof.obj" --png "$work/valley" >/dev/null

mkdir -p "$out"
cp "$work/kidney/flat.png" "$out/kidney-flat.png"
cp "$work/kidney/simulated.png" "$out/kidney-simulated.png"
cp "$work/valley/curvature.png" "$out/valley-curvature.png"
cp "$work/valley/simulated.png" "$out/valley-simulated.png"
