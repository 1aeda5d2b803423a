#!/bin/sh
# usage: subproject.sh SOURCE_DIR CMAKE GENERATOR CC CXX: configures a project that has vox within it.
set -eu
source=$1 cmake=$2 generator=$3 cc=$4 cxx=$5
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" -S "$source/tests/install/parent" -B "$scratch" -G "$generator" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" \
    -DVOX_SOURCE="$source" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
"$cmake" --install "$scratch" --prefix "$scratch/prefix" >"$scratch/log"
[ ! -e "$scratch/prefix" ] || { echo "the parent installs what is not its own:"; find "$scratch/prefix"; exit 1; }
