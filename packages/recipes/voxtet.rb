class Voxtet < Formula
  desc "Exact collision detection for deformable tetrahedral meshes on a voxel grid"
  homepage "@HOMEPAGE@"
  url "@URL@"
  version "@VERSION@"
  sha256 "@SHA256@"
  license "MIT"

  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "pkgconf" => :test
  depends_on "pugixml"

  uses_from_macos "zlib"

  def install
    system "cmake", "-S", ".", "-B", "build", "-DVOX_BUILD_TESTS=OFF", "-DVOX_BUILD_EXAMPLES=OFF",
           "-DVOX_BUILD_TOOLS=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    (testpath/"test.c").write <<~C
      #include <vox/vox.h>
      int main(void) {
        vox_grid* grid;
        return vox_grid_create(NULL, &grid) != VOX_OK || vox_grid_step(grid) != VOX_OK;
      }
    C
    system ENV.cc, "test.c", "-I#{include}", "-L#{lib}", "-lvox", "-o", "test"
    system "./test"
  end
end
