# Sourced by ./run and ./test: what they need from Debian, and building a preset. Says what it does on stderr only.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# install_packages KIND...: installs what tools/packages.txt lists under these kinds and is not there yet.
install_packages() {
    command -v dpkg-query >/dev/null || return 0 # not Debian: the build names what it misses
    local kinds=" $* " kind name missing=()
    local present
    present=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' 2>/dev/null | sed -n 's/^installed //p')
    while read -r kind name; do
        [[ $kinds == *" $kind "* ]] || continue
        grep -qxF -- "$name" <<<"$present" || command -v -- "$name" >/dev/null || missing+=("$name")
    done < <(grep -v '^#' "$root/tools/packages.txt")
    ((${#missing[@]})) || return 0

    local as=()
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            printf 'These Debian packages are missing. Install them as root, then start again:\n\n    apt-get install %s\n\n' \
                "${missing[*]}" >&2
            return 1
        fi
        as=(sudo)
    fi
    printf 'Installing from Debian%s: %s\n' "${as[0]:+ (through sudo)}" "${missing[*]}" >&2
    local log
    log=$(mktemp)
    if ! { "${as[@]}" apt-get -qq update &&
           "${as[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install "${missing[@]}"; } \
           >"$log" 2>&1; then
        cat "$log" >&2
        rm -f "$log"
        printf 'The packages could not be installed.\n' >&2
        return 1
    fi
    rm -f "$log"
}

# build PRESET [TARGET...]: configures once, builds what changed, and prints the log only if that fails. One build of a folder
# runs at a time, so several ./run may start together.
build() {
    local preset=$1 folder="$root/build/$1"
    shift
    mkdir -p "$folder"
    (
        flock 9
        log="$folder/build.log"
        if [[ ! -f $folder/build.ninja ]]; then
            printf 'Building auxshell (%s), once\n' "$preset" >&2
            (cd "$root" && cmake --preset "$preset") >"$log" 2>&1 9>&- || { cat "$log" >&2; exit 1; }
        fi
        ninja --quiet -C "$folder" "$@" >"$log" 2>&1 9>&- || { cat "$log" >&2; exit 1; }
    ) 9>"$folder/.lock"
}
