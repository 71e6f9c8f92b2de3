#!/usr/bin/env bash
# Makes what is drawn or written by the program itself again: example surfaces, README pictures, command reference.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
install_packages run test docs
build release
bin=$root/build/release/bin
mkdir -p "$root/docs/pictures"
"$bin/make_surfaces" "$root/examples/surfaces"
"$bin/make_room" "$root/examples/room"
"$bin/make_pictures" "$root/examples/surfaces" "$root/docs/pictures"
"$bin/auxshell" --reference >"$root/docs/command.md"
"$bin/auxshell" operators --markdown >"$root/docs/operators.md"
"$bin/make_figure_4" "$root/examples/figure-4.json" "$root/docs/pictures/figure-4.png"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$bin/auxshell" design "$root/examples/surfaces/spherical_cap.obj" -o "$scratch/dome.auxshell" --triangles 100 --units m --load gravity >/dev/null
"$bin/auxshell" export "$scratch/dome.auxshell" -o "$root/examples/grasshopper/dome.json" >/dev/null
"$bin/auxshell" design "$root/examples/surfaces/kidney_dome.obj" -o "$scratch/kidney.auxshell" --triangles 400 --units m >/dev/null
"$bin/auxshell" export "$scratch/kidney.auxshell" -o "$scratch/kidney.plan.pdf" --date none --joint ring --material plywood-3 >/dev/null
for page in 2:layout 4:steps 7:frame; do
  pdftoppm -r 60 -png -singlefile -f "${page%:*}" "$scratch/kidney.plan.pdf" "$root/docs/pictures/plan-${page#*:}"
done
for name in hybrid-shell pavilion cladding mars-habitat pavilion-middle pavilion-inner; do
  "$bin/auxshell" run "$root/examples/$name.json" -o "$scratch/$name.auxshell" >/dev/null
done
"$bin/auxshell" shade "$scratch/pavilion.auxshell" "$scratch/pavilion-middle.auxshell" "$scratch/pavilion-inner.auxshell" \
  --place 47.38,8.54 --date 2026-06-21 --zone 2 --hours 10,17 --want 0,2,1.2,0.5 --want -2.3,2.5,0.8,0.42 --want 2.3,2,0.8,0.33 \
  --arrange --shift 0.8 --png "$root/docs/pictures/shade-pavilion.png" >/dev/null
"$bin/auxshell" export "$scratch/hybrid-shell.auxshell" -o "$scratch/hybrid-shell.plan.pdf" --date none >/dev/null
pdftoppm -r 60 -png -singlefile -f 13 "$scratch/hybrid-shell.plan.pdf" "$root/docs/pictures/plan-arch"
"$bin/make_figure_5" "$scratch/figure-5.png" "$scratch"/{pavilion,cladding,mars-habitat,hybrid-shell}.auxshell
cwebp -quiet -q 88 "$scratch/figure-5.png" -o "$root/docs/pictures/figure-5.webp"
mkdir "$scratch/frames"
"$bin/make_deployment" "$root/examples/mars-habitat.json" "$scratch/frames" 42 640 400 >/dev/null
frames=("$scratch"/frames/*.png)
img2webp -loop 0 -lossy -q 60 -m 6 -d 900 "${frames[0]}" -d 80 "${frames[@]:1:40}" -d 1600 "${frames[41]}" \
  -o "$root/docs/pictures/deployment.webp" >/dev/null
# Pictures of the gallery as WebP: a tenth of the size.
"$bin/auxshell" gallery --page "$root/docs/gallery.md" >/dev/null
for picture in "$root"/docs/pictures/gallery/*.png; do
  cwebp -quiet -q 88 "$picture" -o "${picture%.png}.webp"
  rm "$picture"
done
sed -i 's/\(pictures\/gallery\/[a-z0-9-]*\)\.png/\1.webp/g' "$root/docs/gallery.md"
