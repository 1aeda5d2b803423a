// The command line tool vox. Its exit codes are 0 for success, 1 for bad input and 2 for wrong usage.
#include "commands.hpp"
#include "failure.hpp"
#include "report.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <new>
#include <string>
#include <vector>

namespace {

int fail(const char* words) {
    std::fflush(stdout); // keeps earlier output before the error text
    std::fprintf(stderr, "vox: %s\n", words);
    return 1;
}

int wrong_usage(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    std::fprintf(stderr, "vox: %s\nRun 'vox %s--help' for the usage.\n", error.what(),
                 chosen.empty() ? "" : (chosen.front()->get_name() + " ").c_str());
    return 2;
}

// The arguments as CLI11 needs them: in reverse order, and with -.5 as -0.5, because it takes -.5 for an
// option.
std::vector<std::string> arguments_of(int argc, char** argv) {
    std::vector<std::string> arguments(std::make_reverse_iterator(argv + argc),
                                       std::make_reverse_iterator(argv + std::min(argc, 1)));
    for (std::string& argument : arguments)
        if (argument.size() > 2 && argument.starts_with("-.") && argument[2] >= '0' && argument[2] <= '9')
            argument.insert(1, "0");
    return arguments;
}

int run(int argc, char** argv) {
    CLI::App app("Exact collision detection for deformable tetrahedral meshes on a voxel grid", "vox");
    app.set_version_flag("--version",
                         std::string("vox ") + vox_version_string() + "\nlibrary: " + vox_build_info());
    app.require_subcommand(1);
    tool::add_demo(app);
    tool::add_info(app);
    tool::add_suggest(app);
    tool::add_collide(app);
    tool::add_replay(app);
    tool::add_sweep(app);
    tool::add_tetrahedralize(app);
    try {
        app.parse(arguments_of(argc, argv)); // also runs the command
        tool::finish_output();
        return 0;
    } catch (const CLI::Success& request) { // --help, --version
        app.exit(request);
        tool::finish_output();
        return 0;
    } catch (const CLI::ParseError& error) {
        return wrong_usage(app, error);
    }
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
