// The command line tool vox. Its exit codes are 0 for success, 1 for bad input and 2 for wrong usage.
#include "commands.hpp"
#include "failure.hpp"
#include "report.hpp"

#include <cstdio>
#include <new>
#include <string>

namespace {

int fail(const char* words) {
    std::fflush(stdout); // keeps earlier output before the error text
    std::fprintf(stderr, "vox: %s\n", words);
    return 1;
}

int run(int argc, char** argv) {
    tool::CommandLine line("vox",
                           std::string("vox ") + vox_version_string() + "\nlibrary: " + vox_build_info(),
                           "Exact collision detection for deformable tetrahedral meshes on a voxel grid");
    tool::add_demo(line);
    tool::add_info(line);
    tool::add_suggest(line);
    tool::add_collide(line);
    tool::add_replay(line);
    tool::add_sweep(line);
    tool::add_tetrahedralize(line);
    const int code = line.run(argc, argv);
    if (code == 0) tool::finish_output();
    return code;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
