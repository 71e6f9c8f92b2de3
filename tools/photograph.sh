#!/usr/bin/env bash
# Photographs a design as it would be built, with Blender's path tracer on the processor:
#   tools/photograph.sh P.auxshell -o PICTURE [options]   PICTURE ends in .png or .jpg; --help lists the options
#   tools/photograph.sh --examples [NAME...]              plays examples and writes docs/pictures/photo-NAME.jpg
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/setup.sh"
install_packages run photograph
build release auxshell_command auxshell_read_mesh
auxshell=$root/build/release/bin/auxshell
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# shoot PICTURE WORD...: words that name documents are given to Blender as design JSON.
shoot() {
    local picture=$1 words=() word
    shift
    for word in "$@"; do
        if [[ $word == *.auxshell ]]; then
            "$auxshell" export "$word" -o "$scratch/${#words[@]}.json" >/dev/null
            word=$scratch/${#words[@]}.json
        fi
        words+=("$word")
    done
    in_blender "${words[0]}" "$(realpath -m "$picture")" "${words[@]:1}" >"$scratch/log" 2>&1 ||
        { grep -v '^Fra:' "$scratch/log" >&2; return 1; }
}

in_blender() { blender --background --factory-startup --python-exit-code 1 --python "$root/tools/photograph/scene.py" -- "$@"; }
usage() { in_blender --help | sed '/^Blender/d'; }

case ${1:-} in
--examples)
    shift
    while read -r name options; do
        [[ $name != \#* && -n $name ]] || continue
        (($# == 0)) || [[ " $* " == *" $name "* ]] || continue
        words=()
        for word in "@$name" $options; do
            if [[ $word == @* ]]; then # a design of the examples
                "$auxshell" run "$root/examples/${word#@}.json" -o "$scratch/${word#@}.auxshell" >/dev/null
                word=$scratch/${word#@}.auxshell
            elif [[ $word == *.obj ]]; then
                word=$root/examples/$word
            fi
            words+=("$word")
        done
        shoot "$root/docs/pictures/photo-$name.jpg" "${words[@]}"
        printf 'Wrote docs/pictures/photo-%s.jpg\n' "$name"
    done <"$root/tools/photograph/shots.txt"
    ;;
*.auxshell)
    document=$1
    [[ ${2:-} == -o && -n ${3:-} ]] || { usage >&2; exit 2; }
    picture=$3
    shift 3
    shoot "$picture" "$document" "$@"
    printf 'Wrote %s\n' "$picture"
    ;;
--help) usage ;;
*) usage >&2; exit 2 ;;
esac
