// What vox_io answers where it is built without a library that a format needs.
#include "io/formats/readers.hpp"
#include "support/suite.h"

#include <cstring>

using namespace vox;
using namespace vox::io;

namespace vox::io {
MeshData read_vtu_without_xml(const File& file, std::uint32_t); // read_vtu of no_xml.cpp
}

namespace {

START_TEST(without_xml) {
    const File file{"folder/a.vtu", "<VTKFile type=\"UnstructuredGrid\">"};
    try {
        (void)read_vtu_without_xml(file, 0);
        ck_abort_msg("was read");
    } catch (const Error& error) {
        ck_assert_int_eq(error.result(), VOX_ERROR_UNSUPPORTED);
        ck_assert_ptr_nonnull(std::strstr(error.what(), "folder/a.vtu: this vox_io was built without"));
        ck_assert_ptr_nonnull(std::strstr(error.what(), "VOX_IO_XML"));
    }
}
END_TEST

} // namespace

SUITE(io_without) { tcase_add_test(add_case(suite, "xml"), without_xml); }
