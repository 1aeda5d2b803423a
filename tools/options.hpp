// Checks of option values that CLI11 does not have, and options shared by commands. A bad value gives exit
// code 2.
#pragma once

#include "body.hpp"

#include <vox/vox.h>

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace tool {

// The names a user may give, with their values; the first is the default.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

inline const Choices<vox_engine> engines = {
    {"auto", VOX_ENGINE_AUTO},
    {"fast", VOX_ENGINE_FAST},
    {"reference", VOX_ENGINE_REFERENCE},
};
inline const Choices<vox_storage> storages = {
    {"auto", VOX_STORAGE_AUTO}, {"hashed", VOX_STORAGE_HASHED}, {"dense", VOX_STORAGE_DENSE}};
inline const Choices<vox_hash> hashes = {{"mixed", VOX_HASH_MIXED}, {"paper", VOX_HASH_PAPER}};

template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& flag, Value& value, const Choices<Value>& choices,
                        const std::string& description) {
    std::string names;
    for (const auto& [name, meaning] : choices) names += (names.empty() ? "" : "|") + name;
    const auto choose = [&value, choices, flag, names](const std::string& given) {
        for (const auto& [name, meaning] : choices)
            if (given == name) {
                value = meaning;
                return;
            }
        throw CLI::ValidationError(flag, "expected " + names + ", found " + given);
    };
    return app.add_option_function<std::string>(flag, choose, description)->type_name(names);
}

// Accepts finite numbers for which `accept` is true; `words` describes them, e.g. "a number above 0".
template <class Accept>
CLI::Validator number_check(Accept accept, const std::string& words) {
    return CLI::Validator(
        [accept, words](const std::string& text) {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            const bool whole = !text.empty() && *end == '\0';
            return whole && std::isfinite(value) && accept(value) ? std::string()
                                                                  : "expected " + words + ", found " + text;
        },
        "");
}

inline CLI::Validator finite() {
    return number_check([](double) { return true; }, "a finite number");
}
inline CLI::Validator positive() {
    return number_check([](double value) { return value > 0; }, "a number above 0");
}
inline CLI::Validator not_negative() {
    return number_check([](double value) { return value >= 0; }, "a number of at least 0");
}
inline CLI::Validator fraction() {
    return number_check([](double value) { return value > 0 && value < 1; }, "a number between 0 and 1");
}

inline void add_threads(CLI::App& app, vox_grid_desc& grid) {
    app.add_option("--threads", grid.worker_count, "Threads of a step; 0: one per core")
        ->check(CLI::Range(0u, VOX_MAX_WORKERS));
}

// How the reference engine stores cells.
inline void add_cells(CLI::App& app, vox_grid_desc& grid) {
    add_choice(app, "--storage", grid.storage, storages, "How cells are stored");
    add_choice(app, "--hash", grid.hash, hashes, "Hash of a cell, for hashed storage");
}

// Adds the options of commands that need tetrahedra but may get surfaces.
inline void add_fill(CLI::App& app, Fill& fill) {
    CLI::Option* flag = app.add_flag("--fill", fill.surfaces, "Fill surfaces with tetrahedra first");
    app.add_option("--fill-cell", fill.cell,
                   "Edge of a lattice cell for --fill; 0: a fiftieth of the longest side")
        ->check(not_negative())
        ->needs(flag);
}

} // namespace tool
