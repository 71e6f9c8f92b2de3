#!/usr/bin/env bash
# Builds the studio's page into build/page, unless it is what its sources make already. All presets share it, and may ask at once.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$root/build/studio out=$root/build/page
mkdir -p "$work"
exec 9>"$root/build/.page.lock"
flock 9

sources() { (cd "$root/studio" && find . \( -name node_modules -o -name dist \) -prune -o -type f -print0 | LC_ALL=C sort -z); }
sum=$(cd "$root/studio" && sources | xargs -0 sha256sum | sha256sum)
[[ -f $out/index.html && $(cat "$work/.built" 2>/dev/null) == "$sum" ]] && exit 0

find "$work" -mindepth 1 -maxdepth 1 ! -name node_modules ! -name .installed -exec rm -r {} +
sources | tar -C "$root/studio" --null -T - -c | tar -C "$work" -x
cd "$work"
lock=$(sha256sum <package-lock.json)
if [[ $(cat .installed 2>/dev/null) != "$lock" ]]; then
    npm ci --no-audit --no-fund --silent
    echo "$lock" >.installed
fi
npm run build --silent -- --outDir "$out" --emptyOutDir
echo "$sum" >.built
