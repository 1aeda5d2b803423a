# The source drop of this release; packages/recipes/write.py names it.
vcpkg_download_distfile(ARCHIVE
  URLS "@URL@"
  FILENAME "voxtet-${VERSION}.tar.xz"
  SHA512 @SHA512@)
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "${ARCHIVE}")

vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS
  FEATURES
    io VOX_BUILD_IO
    sim VOX_BUILD_SIM
    tbb VOX_TBB)

vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    ${FEATURE_OPTIONS}
    "-DVOX_HIGHWAY_INCLUDE_DIR=${CURRENT_INSTALLED_DIR}/include"
    -DVOX_BUILD_TESTS=OFF
    -DVOX_BUILD_EXAMPLES=OFF
    -DVOX_BUILD_TOOLS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME vox CONFIG_PATH lib/cmake/vox)
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
