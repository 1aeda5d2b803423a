#include "by_assimp.hpp"

#include "failure.hpp"

#if defined(__unix__) || defined(__APPLE__)

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tool {

namespace {

constexpr rlim_t most_seconds = 60;            // of processor time; twice as much in total
constexpr rlim_t most_bytes = rlim_t{4} << 30; // in addition to what this process has

// The process writes this header into its pipe, then the text of an error, positions, triangles.
struct Answer {
    vox_result result;
    std::uint64_t text_size, vertices, triangles;
    vox_io_report report;
};

// AddressSanitizer reserves terabytes of address space, so no limit can be set under it.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool address_sanitizer = true;
#elif defined(__has_feature)
constexpr bool address_sanitizer = __has_feature(address_sanitizer);
#else
constexpr bool address_sanitizer = false;
#endif

void limit(int resource, rlim_t most) {
    rlimit values{};
    if (getrlimit(resource, &values) != 0) return;
    values.rlim_cur = std::min(most, values.rlim_max);
    setrlimit(resource, &values);
}

// The bytes of address space that this process has (Linux; elsewhere 0).
rlim_t address_space() {
    unsigned long long pages = 0;
    if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
        std::fclose(file);
    }
    return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void put(int pipe, const void* data, std::size_t size) {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = write(pipe, bytes, std::min<std::size_t>(size, std::size_t{1} << 20));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) _exit(1);
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
}

[[noreturn]] void read_and_answer(const std::string& path, int pipe) {
    if (!address_sanitizer) limit(RLIMIT_AS, address_space() + most_bytes);
    limit(RLIMIT_CPU, most_seconds);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);                          // it has no file to write
    const int nowhere = open("/dev/null", O_WRONLY); // for messages of a library that aborts
    if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.format = VOX_IO_FORMAT_ASSIMP;
    vox_io_mesh* mesh = nullptr;
    Answer answer{};
    answer.result = vox_io_load(path.c_str(), &desc, &mesh);
    if (answer.result != VOX_OK) {
        const char* const text = vox_last_error();
        answer.text_size = std::strlen(text);
        put(pipe, &answer, sizeof answer);
        put(pipe, text, answer.text_size);
        _exit(0);
    }
    vox_io_mesh_view view{};
    vox_io_mesh_get_arrays(mesh, &view);
    answer.vertices = view.vertex_count;
    answer.triangles = view.triangle_count;
    answer.report.struct_size = sizeof answer.report;
    vox_io_mesh_get_report(mesh, &answer.report);
    put(pipe, &answer, sizeof answer);
    put(pipe, view.positions, 24 * view.vertex_count);
    put(pipe, view.triangles, 12 * view.triangle_count);
    _exit(0);
}

// Whether the library has a reader of its own for files of that name, which knows best why it refused one.
bool has_own_reader(const std::string& path) {
    const std::size_t dot = path.find_last_of("./\\");
    if (dot == std::string::npos || path[dot] != '.') return false;
    std::string extension = path.substr(dot + 1);
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    for (const char* const own : {"msh", "node", "ele", "mesh", "veg", "vtk", "vtu", "vtp", "inp", "obj",
                                  "ply", "stl", "off", "gltf", "glb"})
        if (extension == own) return true;
    return false;
}

// The reading end. It trusts nothing in the pipe, as the file may have taken over the process.
class Child {
public:
    Child(const std::string& path, std::string refused)
        : refused_(std::move(refused)), own_(has_own_reader(path)) {
        std::array<int, 2> ends{};
        if (pipe(ends.data()) != 0) fail(std::strerror(errno));
        child_ = fork();
        if (child_ == 0) {
            close(ends[0]);
            read_and_answer(path, ends[1]);
        }
        close(ends[1]);
        pipe_ = ends[0];
        if (child_ < 0) fail(std::strerror(errno));
    }
    ~Child() {
        close(pipe_);
        if (child_ > 0) end();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void get(void* data, std::size_t size) {
        char* bytes = static_cast<char*>(data);
        while (size > 0) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                deadline_ - std::chrono::steady_clock::now());
            pollfd ready{pipe_, POLLIN, 0};
            const int events = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
            if (events == 0) fail("it took too long and was ended");
            const ssize_t got = events > 0 ? read(pipe_, bytes, size) : -1;
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) fail(how_it_ended());
            bytes += got;
            size -= static_cast<std::size_t>(got);
        }
    }

    [[noreturn]] void fail(const std::string& words) const {
        throw Failure(own_ ? refused_ : refused_ + "; assimp, in a process of its own: " + words);
    }
    [[noreturn]] void give_up() const { throw Failure(refused_); }

private:
    int end() {
        kill(child_, SIGKILL);
        int status = 0;
        while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
        }
        child_ = -1;
        return status;
    }

    // The pipe ended too early, but the process may still run. If it has ended by itself, it keeps its
    // status.
    std::string how_it_ended() {
        const int status = end();
        if (!WIFSIGNALED(status)) return "it ended without an answer";
        if (WTERMSIG(status) == SIGXCPU) return "it used more processor time than a minute";
        return std::string("it was ended by a signal: ") + strsignal(WTERMSIG(status));
    }

    std::string refused_;
    bool own_;
    pid_t child_ = -1;
    int pipe_ = -1;
    std::chrono::steady_clock::time_point deadline_ =
        std::chrono::steady_clock::now() + std::chrono::seconds(2 * most_seconds);
};

} // namespace

Mesh load_by_assimp(const std::string& path, const std::string& refused, vox_io_report& report) {
    Child child(path, refused);
    Answer answer{};
    child.get(&answer, sizeof answer);
    if (answer.result == VOX_ERROR_UNSUPPORTED) child.give_up();
    if (answer.result == VOX_ERROR_OUT_OF_MEMORY) child.fail("it needed more memory than 4 GiB");
    if (answer.result != VOX_OK) {
        std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(answer.text_size, 4096)), ' ');
        child.get(text.data(), text.size());
        child.fail(text);
    }
    if (answer.vertices > most_bytes / 24 || answer.triangles > most_bytes / 12)
        child.fail("it answers nonsense");
    std::vector<double> positions(3 * answer.vertices);
    std::vector<std::uint32_t> triangles(3 * answer.triangles);
    child.get(positions.data(), 24 * answer.vertices);
    child.get(triangles.data(), 12 * answer.triangles);
    const vox_io_mesh_view arrays{positions.data(), answer.vertices, nullptr, 0,      triangles.data(),
                                  answer.triangles, nullptr,         nullptr, nullptr};
    vox_io_mesh* mesh = nullptr;
    check(vox_io_mesh_create(&arrays, &mesh));
    report = answer.report;
    return Mesh(mesh);
}

} // namespace tool

#else

namespace tool {

Mesh load_by_assimp(const std::string&, const std::string& refused, vox_io_report&) {
    throw Failure(refused);
}

} // namespace tool

#endif
