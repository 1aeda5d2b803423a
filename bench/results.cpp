#include "results.hpp"

#include "timing.h"

#include <vox/vox.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace bench {
namespace {

const char* kind_name(Kind kind) {
    switch (kind) {
    case Kind::vox:
        return "vox";
    case Kind::peer:
        return "peer";
    case Kind::floor:
        return "floor";
    }
    return "";
}

// RFC 4180.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char c : text) {
        if (c == '"') out += c;
        out += c;
    }
    return out + '"';
}

std::string ratio(double value) {
    if (value <= 0) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", value < 10 ? 2 : 0, value);
    return text;
}

} // namespace

double Result::median() const { return ::median(seconds); }

double Result::fastest() const { return seconds.empty() ? 0 : std::ranges::min(seconds); }

void print(const SceneResult& scene) {
    double contacts_alone = 0, reference = 0, best_peer = 0;
    for (const Result& r : scene.results) {
        if (r.entrant == contacts_name) contacts_alone = r.median();
        if (r.entrant == reference_name) reference = r.median();
        if (r.kind == Kind::peer && (best_peer == 0 || r.median() < best_peer)) best_peer = r.median();
    }
    std::printf("\n%s (%s): %zu tets, %zu vertices, %zu bodies, %zu contacts\n", scene.scene.c_str(),
                scene.title.c_str(), scene.tets, scene.vertices, scene.bodies, scene.contacts);
    std::printf("  %-22s %10s %10s %8s %12s %12s %12s %8s %10s %7s\n", "", "median ms", "fastest ms",
                "ns/tet", "/ contacts", "x reference", "x best peer", "B/tet", "cell/edge", "steps");
    const double tets = static_cast<double>(scene.tets);
    for (const Result& r : scene.results) {
        const double median = r.median();
        const double over_contacts = contacts_alone > 0 ? median / contacts_alone : 0;
        std::printf("  %-22s %10.3f %10.3f %8.2f %12s %12s %12s %8s %10s %7zu%s\n", r.entrant.c_str(),
                    1e3 * median, 1e3 * r.fastest(), 1e9 * median / tets,
                    r.entrant == subject_name ? ratio(over_contacts).c_str() : "-",
                    ratio(reference / median).c_str(), ratio(best_peer / median).c_str(),
                    ratio(static_cast<double>(r.bytes) / tets).c_str(),
                    ratio(r.cell_size / scene.mean_edge).c_str(), r.seconds.size(),
                    r.agrees ? "" : "  WRONG CONTACTS");
    }
    std::fflush(stdout);
}

Csv::Csv(const std::string& path, const std::string& command) : file_(std::fopen(path.c_str(), "w")) {
    if (!file_) throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
    char date[32];
    const std::time_t now = std::time(nullptr);
    std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
    run_ =
        std::string(date) + ',' + quoted(cpu_name()) + ',' + quoted(vox_build_info()) + ',' + quoted(command);
    std::fputs(
        "date,cpu,build,command,scene,title,tets,vertices,bodies,contacts,mean_edge,entrant,kind,steps,"
        "median_ns,fastest_ns,setup_ns,bytes,cell_size,agrees\n",
        file_);
}

Csv::~Csv() { std::fclose(file_); }

// What is the same in every row is in the first one alone.
void Csv::add(const SceneResult& scene) {
    for (const Result& r : scene.results) {
        std::fprintf(file_, "%s,%s,%s,%zu,%zu,%zu,%zu,%.9g,%s,%s,%zu,%.0f,%.0f,%.0f,%zu,%.9g,%d\n",
                     run_.c_str(), scene.scene.c_str(), quoted(scene.title).c_str(), scene.tets,
                     scene.vertices, scene.bodies, scene.contacts, scene.mean_edge, quoted(r.entrant).c_str(),
                     kind_name(r.kind), r.seconds.size(), 1e9 * r.median(), 1e9 * r.fastest(),
                     1e9 * r.setup_seconds, r.bytes, r.cell_size, r.agrees ? 1 : 0);
        run_ = ",,,";
    }
    std::fflush(file_);
}

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name"))
            if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "unknown processor";
}

} // namespace bench
