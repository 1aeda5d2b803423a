#!/bin/sh
# usage: subproject.sh SOURCE_DIR CMAKE GENERATOR CC CXX: configures a project that has vox within it.
set -eu
source=$1 cmake=$2 generator=$3 cc=$4 cxx=$5
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
configure() { # SOURCE BUILD [OPTION...]
    from=$1 to=$2
    shift 2
    "$cmake" -S "$source/$from" -B "$scratch/$to" -G "$generator" -DCMAKE_C_COMPILER="$cc" \
        -DCMAKE_CXX_COMPILER="$cxx" -DVOX_SOURCE="$source" "$@" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
}
configure tests/install/parent parent
"$cmake" --install "$scratch/parent" --prefix "$scratch/prefix" >"$scratch/log"
[ ! -e "$scratch/prefix" ] || { echo "the parent installs what is not its own:"; find "$scratch/prefix"; exit 1; }

# So it is however the parent gets it, and whatever the parent's settings are.
configure tests/install/parent fetched -DVOX_BY_FETCH="$source"
configure tests/install/parent merged -DCMAKE_UNITY_BUILD=ON -DVOX_UNITY=OFF
if command -v git >/dev/null && git -C "$source" rev-parse --git-dir >/dev/null 2>&1 && command -v python3 >/dev/null; then
    python3 -B "$source/packages/source_drop.py" "$scratch/drop.tar.xz" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
    configure tests/install/parent unpacked -DVOX_BY_FETCH="file://$scratch/drop.tar.xz"
fi

# Where the parent asks for it, vox is installed, and can be found.
configure tests/install/parent parent -DVOX_INSTALL=ON
configure tests/install/consumer consumer -Dvox_DIR="$scratch/parent/vox"

# From the build folder of static libraries too: whoever takes them needs none of the headers that they were compiled with.
configure . static -DBUILD_SHARED_LIBS=OFF -DVOX_BUILD_TOOLS=OFF -DVOX_BUILD_TESTS=OFF -DVOX_BUILD_EXAMPLES=OFF
configure tests/install/consumer from_static -Dvox_DIR="$scratch/static" "-DCOMPONENTS=io;sim"
