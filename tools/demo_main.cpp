// vox_demo: the demo as a separate program, which compiles in seconds. It needs the core, and vox_io's ball.
#include "failure.hpp"
#include "io/solids/bodies.hpp"
#include "two_balls.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string_view>

namespace {

int wrong_usage() {
    std::fprintf(stderr, "usage: vox_demo [--tets N] [--frames N]\n"
                         "./dev vox demo --help has more, with the whole command line\n");
    return 2;
}

// A whole number from 1 to `most`.
template <class Number>
bool read(std::string_view text, Number most, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() && number >= 1 && number <= most;
}

} // namespace

int main(int argc, char** argv) {
    std::uint64_t tets = 20000;
    std::uint32_t frames = 12;
    for (int i = 1; i < argc; i += 2) {
        const std::string_view name = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
        if (!(name == "--tets" && read<std::uint64_t>(value, 100000000, tets)) &&
            !(name == "--frames" && read<std::uint32_t>(value, 1000000, frames)))
            return wrong_usage();
    }
    try {
        const vox::io::MeshData ball = vox::io::make_lattice_ball(tets, 1);
        tool::TwoBalls balls(ball.positions, ball.tets);
        balls.print_balls();
        balls.run(frames);
        balls.print_results("./dev vox");
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vox_demo: %s\n", error.what());
        return 1;
    }
}
