"""Conan 2's recipe. It packages the sources of this repository, or of a source drop, around it: `conan create packages/conan`."""
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy

required_conan_version = ">=2.0"


class Voxtet(ConanFile):
    name = "voxtet"
    package_type = "library"
    license = "MIT"
    description = "Exact collision detection for deformable tetrahedral meshes on a voxel grid"
    topics = ("collision-detection", "tetrahedra", "mesh", "simulation")
    settings = "os", "arch", "compiler", "build_type"
    # vendored: headers of the source drop or of the system, where Conan's packages cannot be had.
    options = {"shared": [True, False], "fPIC": [True, False], "with_io": [True, False], "with_sim": [True, False],
               "with_tbb": [True, False], "vendored": [True, False]}
    default_options = {"shared": False, "fPIC": True, "with_io": True, "with_sim": True, "with_tbb": False, "vendored": False}
    implements = ["auto_shared_fpic"]
    no_copy_source = True

    def _sources(self):
        return os.path.join(self.recipe_folder, os.environ.get("VOX_SOURCE", "../.."))

    def set_version(self):
        with open(os.path.join(self._sources(), "include/vox/vox.h"), encoding="utf-8") as file:
            header = file.read()
        self.version = ".".join(re.search(rf"#define VOX_VERSION_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH"))

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "adapters/*", "include/*", "src/*", "third_party/*"):
            copy(self, pattern, self._sources(), self.export_sources_folder)

    def requirements(self):
        if self.options.with_tbb:
            self.requires("onetbb/[>=2021.5]")
        if self.options.vendored:
            return
        self.requires("highway/[>=1.0.3 <2]", visible=False)
        if self.options.with_io or self.options.with_sim:
            self.requires("eigen/[>=3.4 <4]", visible=False)
        if self.options.with_io:
            self.requires("nlohmann_json/[>=3.10 <4]", visible=False)
            self.requires("pugixml/[>=1.11 <2]")
            self.requires("zlib/[>=1.2.11 <2]")

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update({
            "VOX_INSTALL": True, "VOX_BUILD_TESTS": False, "VOX_BUILD_EXAMPLES": False, "VOX_BUILD_TOOLS": False,
            "VOX_BUILD_IO": bool(self.options.with_io), "VOX_BUILD_SIM": bool(self.options.with_sim),
            "VOX_IO_XML": not self.options.vendored, "VOX_TBB": bool(self.options.with_tbb)})
        if not self.options.vendored:
            highway = self.dependencies["highway"].cpp_info.includedirs[0]
            toolchain.cache_variables["VOX_HIGHWAY_INCLUDE_DIR"] = highway.replace("\\", "/")
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        # The CMake files of vox itself, with the names that its documents use; pkg-config's are Conan's.
        self.cpp_info.set_property("cmake_find_mode", "both")
        self.cpp_info.set_property("cmake_file_name", "vox")
        for component in ("vox", *(["io"] if self.options.with_io else []), *(["sim"] if self.options.with_sim else [])):
            info = self.cpp_info.components[component]
            library = "vox" if component == "vox" else f"vox_{component}"
            info.libs = [library]
            info.set_property("cmake_target_name", f"vox::{component}")
            info.set_property("pkg_config_name", library)
            if component != "vox":
                info.requires = ["vox"]
            elif self.options.with_tbb:
                info.requires = ["onetbb::onetbb"]
            if not self.options.shared:
                info.defines = ["VOX_STATIC"]
                if self.settings.os in ("Linux", "FreeBSD"):
                    info.system_libs = ["m", "pthread"]
            if component == "io" and not self.options.vendored:
                info.requires += ["nlohmann_json::nlohmann_json", "pugixml::pugixml", "zlib::zlib"]
            if not self.options.vendored:
                info.requires += ["highway::highway"] if component == "vox" else ["eigen::eigen"]
