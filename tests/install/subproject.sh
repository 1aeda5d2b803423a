#!/bin/sh
# usage: subproject.sh SOURCE_DIR CMAKE GENERATOR CC CXX: configures a project that has vox within it.
set -eu
source=$1 cmake=$2 generator=$3 cc=$4 cxx=$5
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
configure() { # SOURCE BUILD [OPTION...]
    from=$1 to=$2
    shift 2
    "$cmake" -S "$source/tests/install/$from" -B "$scratch/$to" -G "$generator" -DCMAKE_C_COMPILER="$cc" \
        -DCMAKE_CXX_COMPILER="$cxx" -DVOX_SOURCE="$source" "$@" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
}
configure parent parent
"$cmake" --install "$scratch/parent" --prefix "$scratch/prefix" >"$scratch/log"
[ ! -e "$scratch/prefix" ] || { echo "the parent installs what is not its own:"; find "$scratch/prefix"; exit 1; }

# Where the parent asks for it, vox is installed, and can be found.
configure parent parent -DVOX_INSTALL=ON
configure consumer consumer -Dvox_DIR="$scratch/parent/vox"
