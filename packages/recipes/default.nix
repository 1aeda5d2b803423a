{ lib, stdenv, fetchurl, cmake, eigen, pugixml, zlib }:

stdenv.mkDerivation rec {
  pname = "voxtet";
  version = "@VERSION@";

  src = fetchurl {
    url = "@URL@";
    sha256 = "@SHA256@";
  };

  nativeBuildInputs = [ cmake ];
  buildInputs = [ eigen pugixml zlib ];

  cmakeFlags = [
    "-DVOX_BUILD_TESTS=OFF"
    "-DVOX_BUILD_EXAMPLES=OFF"
    "-DVOX_BUILD_TOOLS=OFF"
  ];

  meta = {
    description = "Exact collision detection for deformable tetrahedral meshes on a voxel grid";
    homepage = "@HOMEPAGE@";
    license = lib.licenses.mit;
    platforms = lib.platforms.unix;
  };
}
