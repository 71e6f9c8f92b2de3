#!/usr/bin/env bash
# Publishes the documents as static pages in build/docs/site, which any web server or the disk itself serves. A broken link fails.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/setup.sh"
install_packages docs
work=$root/build/docs
rm -rf "$work"
mkdir -p "$work/pages"
# Pages lie as in the project, so that links between them need no change. README.md becomes the home page.
cd "$root"
cp -r README.md CHANGELOG.md CONTRIBUTING.md LICENSE docs examples include "$work/pages/"
install -D -t "$work/pages/src" src/layers.txt src/CMakeLists.txt
cp tools/site/site.css "$work/pages/"
{
    cat tools/site/mkdocs.yml
    printf 'nav:\n  - Auxshell: README.md\n  - Documents:\n    - Overview: docs/index.md\n'
    sed -n 's|^- \[\(.*\)\](\(.*\.md\)).*|    - "\1": docs/\2|p' docs/index.md # in the order of the index
    printf '  - Changes: CHANGELOG.md\n  - Contributing: CONTRIBUTING.md\n'
} >"$work/mkdocs.yml"
mkdocs build --config-file "$work/mkdocs.yml" >"$work/log" 2>&1 || { grep -v '^INFO' "$work/log" >&2; exit 1; }
printf 'Wrote %s\n' "$work/site/index.html"
