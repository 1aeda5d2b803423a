// The command line tool vox. Exit codes: 0 for success, 1 for bad input, 2 for wrong usage, 3 if vox check or
// vox resolve leaves crossings.
#include "commands.hpp"
#include "failure.hpp"
#include "manual.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <cstdio>
#include <memory>
#include <new>
#include <string>
#ifdef _WIN32
#include "paths.hpp"

#include <vector>
#endif

namespace {

int fail(const char* words) {
    std::fflush(stdout); // keeps earlier output before the error text
    std::fprintf(stderr, "vox: %s\n", tool::shown(words).c_str());
    return 1;
}

std::string version() { // "vox 0.1.0, gcc ..."
    const std::string info = vox_build_info();
    return info.substr(4, info.find(',') - 4);
}

// The command that writes the installed manual page and completions, run by cmake.
void add_generate(tool::CommandLine& line) {
    using Make = std::string (*)(const tool::Usage&);
    static constexpr tool::Choice<Make> makes[] = {
        {"man", [](const tool::Usage& usage) { return tool::manual_page(usage, version()); }},
        {"bash", tool::bash_completion},
        {"zsh", tool::zsh_completion},
        {"fish", tool::fish_completion}};
    const auto make = std::make_shared<Make>(nullptr);
    tool::Command command = line.add("generate", "Print the manual page, or completions for a shell");
    command.choice("WHAT", *make, makes, "What to print").required();
    command.runs([make, &line] {
        const std::string text = (*make)(line.usage());
        std::fwrite(text.data(), 1, text.size(), stdout);
    });
}

int run(int argc, char** argv) {
    tool::CommandLine line("vox", vox_build_info(),
                           "Exact collision detection for deformable tetrahedral meshes on a voxel grid");
    tool::add_demo(line);
    tool::add_info(line);
    tool::add_check(line);
    tool::add_suggest(line);
    tool::add_collide(line);
    tool::add_replay(line);
    tool::add_sweep(line);
    tool::add_resolve(line);
    tool::add_tetrahedralize(line);
    add_generate(line);
    int code = 0;
    try {
        code = line.run(argc, argv);
    } catch (const tool::Verdict& verdict) {
        tool::finish_output();
        return verdict.code;
    }
    if (code == 0) tool::finish_output();
    return code;
}

// What `body` returns; an exception is reported on stderr.
template <class Body>
int reported(Body&& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}

} // namespace

#ifdef _WIN32
int wmain(int argc, wchar_t** argv) {
    return reported([&] {
        const tool::Console console;
        std::vector<std::string> texts;
        for (int i = 0; i < argc; ++i) texts.push_back(tool::utf8_of(argv[i]));
        std::vector<char*> arguments;
        for (std::string& text : texts) arguments.push_back(text.data());
        return run(argc, arguments.data());
    });
}
#else
int main(int argc, char** argv) {
    return reported([&] { return run(argc, argv); });
}
#endif
