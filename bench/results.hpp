// What was measured, and how it is reported: a table for the reader, rows for the file.
#pragma once

#include "entrant.hpp"

#include <cstdio>
#include <string>
#include <vector>

namespace bench {

struct Result {
    std::string entrant;
    Kind kind;
    std::vector<double> seconds; // one per timed step
    double setup_seconds;
    std::size_t bytes;
    double cell_size;
    bool agrees; // found the same contacts as all others, in every frame

    double median() const;
    double fastest() const;
};

struct SceneResult {
    std::string scene, title;
    std::size_t tets, vertices, bodies, contacts;
    double mean_edge;
    std::vector<Result> results;
};

void print(const SceneResult& scene);

// The same rows for later: each names machine, compiler, date and command.
class Csv {
public:
    Csv(const std::string& path, const std::string& command);
    ~Csv();
    Csv(const Csv&) = delete;
    Csv& operator=(const Csv&) = delete;
    void add(const SceneResult& scene);

private:
    std::FILE* file_;
    std::string run_; // the fields that all rows share, empty after the first
};

std::string cpu_name();

} // namespace bench
