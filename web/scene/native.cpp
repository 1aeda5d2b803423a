// The scene without a page. Runs commands from its input, one a line, as the page's tests run them in the
// browser, and prints what they compare:
//     drop KIND TETS
//     file PATH TETS Y_UP
//     steps N
//     grab FROM TO, three numbers each
//     drag POINT
//     let-go
//     hold TOOL POINT ALONG
//     touched
//     cut EYE FIRST SECOND
//     configure ENGINE SELF STIFFNESS
//     size CELL_SIZE
//     save PATH
//     load PATH
#include "playground.h"

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace {

[[noreturn]] void stop(const std::string& line) {
    std::fprintf(stderr, "%s: %s\n", line.c_str(), vox_last_error());
    std::exit(1);
}

std::vector<char> bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

int main() {
    playground* play = nullptr;
    if (play_create(0, &play) != VOX_OK) stop("create");
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string command, path;
        words >> command;
        if (command == "file" || command == "save" || command == "load") words >> path;
        std::vector<double> n(9);
        for (double& number : n) words >> number;
        const auto whole = [&n](std::size_t i) { return static_cast<std::uint32_t>(n[i]); };
        vox_result result = VOX_OK;
        if (command == "drop") {
            result = play_drop(play, whole(0), whole(1));
        } else if (command == "file") {
            const std::vector<char> bytes = bytes_of(path);
            result = play_drop_file(play, path.c_str(), bytes.data(), bytes.size(), whole(0), whole(1));
        } else if (command == "steps") {
            double step_ns = 0, detect_ns = 0, contacts = 0, deepest = 0;
            for (std::uint32_t i = 0; i < whole(0) && result == VOX_OK; ++i) {
                result = play_step(play);
                const play_facts* facts = play_get_facts(play);
                step_ns += facts->step_ns, detect_ns += facts->detect_ns, contacts += facts->contacts;
                deepest = facts->deepest > deepest ? facts->deepest : deepest;
            }
            const play_facts* facts = play_get_facts(play);
            std::printf("%.0f steps, %.0f tets, hash %016" PRIx64
                        ", %.0f contacts in all, deepest %.3f, speed %.3f, asleep %.0f\n",
                        facts->steps, facts->tets, play_hash(play), contacts, deepest, facts->max_speed,
                        facts->asleep);
            std::fprintf(stderr, "%.3f ms a step, %.3f ms of it detection\n", step_ns / n[0] * 1e-6,
                         detect_ns / n[0] * 1e-6);
        } else if (command == "grab") {
            double point[3];
            std::uint32_t found = 0;
            result = play_grab(play, n.data(), n.data() + 3, point, &found);
            std::printf("grabbed %u\n", found);
        } else if (command == "drag") {
            play_drag(play, n.data());
        } else if (command == "let-go") {
            play_let_go(play);
        } else if (command == "hold") {
            result = play_hold(play, whole(0), n.data() + 1, n.data() + 4);
        } else if (command == "touched") {
            std::uint32_t lines = 0;
            (void)play_touched(play, &lines);
            std::printf("touched %.0f, %u lines\n", play_get_facts(play)->touched, lines);
        } else if (command == "cut") {
            std::uint32_t count = 0;
            result = play_cut(play, n.data(), n.data() + 3, n.data() + 6, &count);
            std::printf("cut %u, %u bodies\n", count, play_body_count(play));
        } else if (command == "configure") {
            result = play_configure(play, whole(0), whole(1), n[2]);
        } else if (command == "size") {
            result = play_set_cell_size(play, n[0]);
        } else if (command == "save") {
            const void* bytes = nullptr;
            std::uint64_t size = 0, hash = 0;
            result = play_save(play, &bytes, &size, &hash);
            if (result == VOX_OK) {
                std::ofstream(path, std::ios::binary)
                    .write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
                std::printf("saved, hash %016" PRIx64 "\n", hash);
            }
        } else if (command == "load") {
            const std::vector<char> bytes = bytes_of(path);
            result = play_load(play, bytes.data(), bytes.size());
        } else if (!command.empty()) {
            std::fprintf(stderr, "no command %s\n", command.c_str());
            return 2;
        }
        if (result != VOX_OK) stop(line);
    }
    play_destroy(play);
}
