# SPDX-License-Identifier: Apache-2.0
# What ./run and ./test share. Sourced, not run; needs `root`, the repository's directory.

# What a bare Debian 12 needs to build and test Sward; cmake/SwardDependencies.cmake has the libraries, and what is not plain of them.
packages=(
    g++ cmake ninja-build pkg-config ccache
    libglfw3-dev libglm-dev libtinygltf-dev libstb-dev libopenvdb-dev libboost-dev libopenimageio-dev libepoxy-dev
    libegl-dev libegl1 libegl-mesa0 libgl1-mesa-dri libglx-mesa0 libimgui-dev libbullet-dev libcli11-dev libfmt-dev
    nlohmann-json3-dev libtomlplusplus-dev libgdal-dev libsqlite3-dev libssl-dev libzstd-dev
    libgtest-dev libtbb-dev libimath-dev libblosc-dev zlib1g-dev
    python3 python3-venv ca-certificates xvfb xauth
)

say() { printf '%s\n' "$*" >&2; }

fail() {
    say "error: $*"
    exit 1
}

# Runs a command as root: directly, or through sudo where the user is not root.
as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        fail "packages: not root and no sudo; as root, run: apt-get install --no-install-recommends ${packages[*]}"
    fi
}

# Installs what is missing. Asks dpkg alone when all is there, so that a second run takes no time and no network.
install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "packages: not a Debian system, so what is installed goes unchecked"
        return
    fi
    local installed missing=() name
    # dpkg-query fails when it knows one of them not; those it knows are listed all the same.
    installed=$( (dpkg-query --show --showformat '${db:Status-Abbrev} ${Package}\n' "${packages[@]}" || true) \
        2>/dev/null | awk '$1 == "ii" { print $2 }' | tr '\n' ' ')
    installed=" $installed "
    for name in "${packages[@]}"; do
        [[ "$installed" == *" $name "* ]] || missing+=("$name")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    say "packages: installing ${missing[*]}"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q >&2 || fail "packages: apt-get update failed"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
        "${missing[@]}" >&2 || fail "packages: apt-get install failed"
}

# configure PRESET [cmake arguments]: only where the build tree is missing or was made without these arguments; after that
# ninja itself notices changed CMake files.
configure() {
    local preset=$1 tree="$root/build/$1" stamp="$root/build/$1/.configured"
    shift
    if [ ! -f "$tree/build.ninja" ] || [[ "$(cat "$stamp" 2>/dev/null)" != *"$*"* ]]; then
        (cd "$root" && cmake --preset "$preset" "$@" >&2) || fail "configure: preset $preset"
        printf '%s\n' "$*" >"$stamp"
    fi
}

# build PRESET [targets]. Paths below the repository are hidden from the compiler's cache, so that all clones share it.
build() {
    local preset=$1
    shift
    export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
    ninja -C "$root/build/$preset" "$@" >&2 || fail "build: preset $preset"
}
