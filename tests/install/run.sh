#!/bin/sh
# usage: run.sh BUILD_DIR SOURCE_DIR CMAKE GENERATOR CC CXX lean|tbb ARCHIVE: installs into a scratch prefix and builds the consumers there, by CMake's
# components and by pkg-config.
set -eu
build=$1 source=$2 cmake=$3 generator=$4 cc=$5 cxx=$6 threads=$7 archive=$8
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/prefix" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
cp "$source"/consumer/* "$scratch"
components=
for component in io sim dist; do
    [ ! -f "$scratch/prefix/include/vox/vox_$component.h" ] || components="$components${components:+;}$component"
done

# What is generated from the options of the program comes with it.
if [ -x "$scratch/prefix/bin/vox" ]; then
    for file in man/man1/vox.1 bash-completion/completions/vox zsh/site-functions/_vox fish/vendor_completions.d/vox.fish; do
        grep -q tetrahedralize "$scratch/prefix/share/$file" || { echo "share/$file is not installed"; exit 1; }
    done
fi

"$cmake" -S "$scratch" -B "$scratch/build" -G "$generator" -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCOMPONENTS="$components" >"$scratch/log" &&
    "$cmake" --build "$scratch/build" >>"$scratch/log" || { cat "$scratch/log"; exit 1; }
"$scratch/build/consumer"
"$scratch/build/consumer_cpp"

PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name vox.pc)")
export PKG_CONFIG_PATH
"$cc" -std=c99 "$scratch/consumer.c" $(pkg-config --cflags --libs vox) -o "$scratch/consumer"
LD_LIBRARY_PATH=$(pkg-config --variable=libdir vox) "$scratch/consumer"
"$cxx" -std=c++20 "$scratch/consumer_cpp.cpp" $(pkg-config --cflags --libs vox) -o "$scratch/consumer_cpp"
LD_LIBRARY_PATH=$(pkg-config --variable=libdir vox) "$scratch/consumer_cpp"

# Shared libraries have what they need linked in: nobody installs its development files to use them.
for component in $(echo "$components" | tr ';' ' '); do
    [ -z "$(pkg-config --print-requires-private "vox_$component")" ] || { echo "vox_$component.pc requires what is linked in"; exit 1; }
done

# What vox.pc names for static linking is all that the core needs besides itself.
"$cc" -std=c99 -DVOX_STATIC "$scratch/consumer.c" $(pkg-config --cflags vox) "$archive" \
    $(pkg-config --static --libs vox | sed 's/-lvox\b//') -o "$scratch/consumer_static"
"$scratch/consumer_static"

for component in $(echo "$components" | tr ';' ' '); do
    "$scratch/build/consumer_$component"
    "$cc" -std=c99 "$scratch/consumer_$component.c" $(pkg-config --cflags --libs "vox_$component") -o "$scratch/consumer_$component"
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir vox) "$scratch/consumer_$component"
done

# Without oneTBB the core needs the C and C++ runtime and nothing else.
if [ "$threads" = lean ] && command -v readelf >/dev/null; then
    library=$(find "$scratch/prefix" -name 'libvox.so' | head -n 1)
    foreign=$(readelf -d "$library" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' |
        grep -vE '^(libstdc\+\+|libc\+\+|libc\+\+abi|libgcc_s|libpthread|libm|libc|ld-linux.*)\.so' || true)
    [ -z "$foreign" ] || { echo "libvox.so needs $foreign"; exit 1; }
fi
