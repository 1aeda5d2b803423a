// Times the kernels of src/gpu on the first CUDA device, and compares what they find with the loops of the host:
// gpu_bench [--small | --sweep]. By itself, without libvox; bench/gpu/run builds it.
#include "gpu/cuda_backend.cu"
#include "gpu/host_backend.hpp"
#include "gpu/pipeline.hpp"

#include "scenes/solids.h"
#include "scenes/waves.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace vox::gpu {
namespace {

constexpr u32 frames = 4; // of positions, slightly different

struct SceneRecipe {
    const char* name;
    double tets; // of all bodies of a scene
    u32 bodies;
    double distance; // of two balls, in radii
    double must, aim; // microseconds; 0: none
    u32 scenes = 1;
    bool self = false, coincident = false;
    double lattice = 0; // coordinates are rounded to multiples of it
};
const SceneRecipe table_scenes[] = {
    {"two balls, 1 % overlap, 1 M", 1e6, 2, 1.834, 100, 60},
    {"two balls, half overlap, 1 M", 1e6, 2, 0.695, 250, 150},
    {"two balls, 3 % overlap, 1 M", 1e6, 2, 1.7, 0, 0},
    {"1000 balls of 1000", 1e6, 1000, 0, 250, 120},
    {"one ball, self, 1 M", 1e6, 1, 0, 250, 150, 1, true},
    {"two balls, 1 % overlap, 100 k", 1e5, 2, 1.834, 0, 0},
    {"two balls, 1 % overlap, 10 k", 1e4, 2, 1.834, 0, 0},
    {"two balls, 3 % overlap, 41 k", 41e3, 2, 1.7, 80, 40},
    {"4096 scenes of 2 balls of 1000", 2000, 2, 1.56, 1000, 500, 4096},
    {"two balls on a lattice, 40 k", 4e4, 2, 1.0, 0, 0, 1, false, false, 0.125},
    {"coincident balls, 20 k", 2e4, 2, 0, 0, 0, 1, false, true},
};
const SceneRecipe small_scenes[] = {
    {"two balls, half overlap", 4000, 2, 0.695, 0, 0},   {"27 balls", 8000, 27, 0, 0, 0},
    {"two balls, self", 4000, 2, 1.0, 0, 0, 1, true},    {"lattice", 4000, 2, 1.0, 0, 0, 1, false, false, 0.125},
    {"coincident", 1500, 2, 0, 0, 0, 1, false, true},    {"8 scenes of 2 balls", 1000, 2, 1.3, 0, 0, 8},
    {"far from each other", 500, 2, 4, 0, 0},
};

struct BuiltScene {
    SceneData data;
    std::array<std::vector<float>, frames> positions;
};

BuiltScene build(const SceneRecipe& recipe, double sides_of_cell = 0) {
    BuiltScene built;
    const double tets = recipe.tets / recipe.bodies, radius = solid_ball_radius(tets);
    const u32 side = recipe.bodies == 2 ? 2 : static_cast<u32>(std::ceil(std::cbrt(recipe.bodies)));
    const double gap = (recipe.bodies == 2 ? recipe.distance : 1.93) * radius;
    // A tile of 60 tets, 12 to a cube of edge 1.
    SceneBuilder builder(sides_of_cell * 2.55);
    std::map<u64, solid> balls;
    for (u32 number = 0; number < recipe.bodies * recipe.scenes; ++number) {
        const u32 b = number % recipe.bodies, odd = recipe.coincident ? 0 : b & 1;
        const u64 seed = recipe.coincident ? 1 : number % (recipe.scenes > 1 ? 256 : 1024) + 1;
        if (!balls.count(seed)) balls.emplace(seed, make_solid_ball(tets, seed));
        const solid& s = balls.at(seed);
        const double at[3] = {gap * (b % side), gap * (b / side % side) + odd * 0.01 * radius,
                              gap * (b / side / side) + odd * 0.02 * radius};
        const std::size_t first = built.positions[0].size();
        for (u32 f = 0; f < frames; ++f)
            for (u32 v = 0; v < s.vertex_count; ++v) {
                const double* p = s.positions + 3 * std::size_t{v};
                double q[3] = {p[0] + at[0], p[1] + at[1], p[2] + at[2]};
                add_sine_waves(0.01 * radius, 3.14159265358979 / radius,
                               (recipe.coincident ? 0 : 0.9 * number) + 0.3 * f, p, q);
                for (double c : q) {
                    if (recipe.lattice > 0) c = std::round(c / recipe.lattice + 0.3) * recipe.lattice + 0.1;
                    built.positions[f].push_back(static_cast<float>(c));
                }
            }
        if (b == 0) builder.begin_scene();
        MeshForDevice mesh{number + 1, s.vertex_count};
        mesh.positions.data = reinterpret_cast<const std::byte*>(&built.positions[0][first]);
        mesh.positions.byte_stride = 3 * sizeof(float);
        mesh.tets = {reinterpret_cast<const Tet*>(s.tets), s.tet_count};
        mesh.self_collision = recipe.self;
        builder.add(mesh);
        if (b + 1 == recipe.bodies) builder.end_scene();
    }
    for (auto& [seed, s] : balls) free_solid(&s);
    built.data = builder.take();
    return built;
}

// Everything that a step gives, to be compared.
struct StepResult {
    StepStatus status{};
    std::vector<vox_contact> contacts;
    std::vector<u8> interiors;
    std::vector<float> weights;
    std::vector<u32> offsets;
};

StepResult result_of(Pipeline& pipeline) {
    StepResult r;
    for (int again = 0;; ++again) {
        r.status = pipeline.finish();
        if (r.status.faults == 0) break;
        if (again == 4) return r;
        pipeline.step(nullptr);
    }
    const SceneArrays& s = pipeline.arrays();
    const std::size_t count = r.status.contact_count;
    r.contacts.resize(count);
    r.interiors.resize(count);
    r.weights.resize(4 * count);
    r.offsets.resize(std::size_t{s.scene_count} + 1);
    pipeline.backend().read(r.contacts.data(), s.contacts, count * sizeof(vox_contact));
    pipeline.backend().read(r.interiors.data(), s.interiors, count);
    pipeline.backend().read(r.weights.data(), s.weights, count * 4 * sizeof(float));
    pipeline.backend().read(r.offsets.data(), s.contact_begin, r.offsets.size() * sizeof(u32));
    return r;
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

int failures = 0;

std::string compare(const StepResult& expected, const StepResult& got) {
    const StepStatus &e = expected.status, &g = got.status;
    const char* differs = g.faults                                           ? "FAULTS"
                          : e.contact_count != g.contact_count               ? "NUMBER OF CONTACTS"
                          : !same(expected.contacts, got.contacts)           ? "CONTACTS"
                          : !same(expected.interiors, got.interiors)         ? "INTERIORS"
                          : !same(expected.weights, got.weights)             ? "WEIGHTS"
                          : !same(expected.offsets, got.offsets)             ? "OFFSETS"
                          : e.exact_tests != g.exact_tests                   ? "EXACT TESTS"
                          : e.needed_findings != g.needed_findings           ? "FINDINGS"
                                                                             : nullptr;
    if (!differs) return "equal";
    ++failures;
    char text[200];
    std::snprintf(text, sizeof text, "DIFFERENT %s: %u contacts of %u, faults %u", differs, g.contact_count,
                  e.contact_count, g.faults);
    return text;
}

double median(std::vector<float> v) {
    if (v.empty()) return 0;
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return static_cast<double>(v[v.size() / 2]);
}

// Keeps the device busy while the host enqueues what is to be timed.
__global__ void be_busy(long long cycles) {
    const long long from = clock64();
    while (clock64() - from < cycles) {}
}
constexpr long long a_while = 150'000; // about 80 microseconds

class DeviceTimer {
public:
    DeviceTimer() {
        check_cuda(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
        for (cudaEvent_t& e : events) check_cuda(cudaEventCreate(&e));
    }
    // Microseconds of f(i), the median of `rounds`. With `cycles` the host is ahead, so that its time does not count.
    template <class F>
    double operator()(u32 rounds, long long cycles, F&& f) {
        std::vector<float> times;
        for (u32 i = 0; i < rounds; ++i) {
            if (cycles) be_busy<<<1, 1, 0, stream>>>(cycles);
            check_cuda(cudaEventRecord(events[0], stream));
            f(i);
            check_cuda(cudaEventRecord(events[1], stream));
            check_cuda(cudaEventSynchronize(events[1]));
            times.push_back(between(0, 1));
        }
        return median(times);
    }
    float between(std::size_t a, std::size_t b) const {
        float ms = 0;
        check_cuda(cudaEventElapsedTime(&ms, events[a], events[b]));
        return 1000 * ms;
    }
    cudaStream_t stream = nullptr;
    std::array<cudaEvent_t, 20> events{};
};

// Records an event after each stage.
class StampingLauncher {
public:
    StampingLauncher(CudaLauncher& launcher, DeviceTimer& timer) : launcher_(launcher), timer_(timer) { stamp(); }
    template <class K>
    void items(u32 n, const K& k) { launcher_.items(n, k), stamp(); }
    template <class K>
    void groups(u32 n, const K& k) { launcher_.groups(n, k), stamp(); }
    template <class K>
    void counted(const u32* n, u32 room, u32 least, const K& k) { launcher_.counted(n, room, least, k), stamp(); }
    void sum(const u32* from, u32* to, u32 n) { launcher_.sum(from, to, n), stamp(); }
    std::size_t stages() const { return next_ - 1; }

private:
    void stamp() { check_cuda(cudaEventRecord(timer_.events[next_++], timer_.stream)); }
    CudaLauncher& launcher_;
    DeviceTimer& timer_;
    std::size_t next_ = 0;
};
constexpr const char* stage_names[] = {"clear", "mark", "risk", "sum", "sum", "place", "look_up", "decide", "sum", "hits", "keep", "sum", "contacts"};

class DeviceScene {
public:
    DeviceScene(const BuiltScene& built, DeviceTimer& timer, u64 bricks = 0)
        : timer_(timer), pipeline_(make_backend(0), built.data, {0, 0, 0, bricks}, UINT64_MAX) {
        for (u32 f = 0; f < frames; ++f) {
            const std::size_t bytes = built.positions[f].size() * sizeof(float);
            positions_[f] = pipeline_.backend().allocate(bytes, false);
            pipeline_.backend().write(positions_[f], built.positions[f].data(), bytes);
        }
        for (u32 f = 0; f < frames; ++f) result(f); // rooms grow, all kernels are loaded
    }
    ~DeviceScene() {
        for (cudaGraphExec_t g : graphs_) cudaGraphExecDestroy(g);
        for (void* p : positions_) pipeline_.backend().release(p);
    }
    void step(u32 frame) {
        pipeline_.bind(positions_[frame], 3 * sizeof(float));
        pipeline_.step(timer_.stream);
    }
    StepResult result(u32 frame) {
        step(frame);
        return result_of(pipeline_);
    }
    void capture() {
        for (u32 f = 0; f < frames; ++f) {
            cudaGraph_t graph = nullptr;
            check_cuda(cudaStreamBeginCapture(timer_.stream, cudaStreamCaptureModeThreadLocal));
            step(f);
            check_cuda(cudaStreamEndCapture(timer_.stream, &graph));
            check_cuda(cudaGraphInstantiate(&graphs_[f], graph, 0));
            check_cuda(cudaGraphDestroy(graph));
        }
    }
    void replay(u32 frame) { check_cuda(cudaGraphLaunch(graphs_[frame], timer_.stream)); }
    double graph_time(u32 rounds) {
        return timer_(rounds, a_while, [&](u32 i) { replay(i % frames); });
    }
    std::vector<double> stage_times(u32 rounds) {
        std::size_t bytes = 0;
        const SceneArrays& s = pipeline_.arrays();
        check_cuda(cub::DeviceScan::ExclusiveSum(nullptr, bytes, s.cell_count, s.cell_begin, static_cast<int>(std::max(s.slots(), s.vertex_count) + 1)));
        void* temporary = pipeline_.backend().allocate(bytes, true);
        CudaLauncher launcher(timer_.stream, 132, temporary, bytes);
        std::vector<std::vector<float>> times;
        for (u32 i = 0; i < rounds; ++i) {
            pipeline_.bind(positions_[i % frames], 3 * sizeof(float));
            be_busy<<<1, 1, 0, timer_.stream>>>(4 * a_while);
            StampingLauncher stamping(launcher, timer_);
            launch_step(stamping, pipeline_.arrays());
            check_cuda(cudaStreamSynchronize(timer_.stream));
            times.resize(stamping.stages());
            for (std::size_t k = 0; k < times.size(); ++k) times[k].push_back(timer_.between(k, k + 1));
        }
        pipeline_.backend().release(temporary);
        std::vector<double> medians;
        for (const auto& t : times) medians.push_back(median(t));
        return medians;
    }
    u64 bytes() const { return pipeline_.bytes(); }

private:
    DeviceTimer& timer_;
    Pipeline pipeline_;
    std::array<void*, frames> positions_{};
    std::array<cudaGraphExec_t, frames> graphs_{};
};

StepResult on_host(const BuiltScene& built, u32 frame) {
    Pipeline pipeline(make_host_backend({}), built.data, {}, UINT64_MAX);
    pipeline.bind(built.positions[frame].data(), 3 * sizeof(float));
    pipeline.step(nullptr);
    return result_of(pipeline);
}

void small(DeviceTimer& timer) {
    for (const SceneRecipe& recipe : small_scenes)
        for (const double sides : {0.0, 0.4, 1.7}) {
            const BuiltScene built = build(recipe, sides);
            DeviceScene device(built, timer);
            device.capture();
            std::string says = "equal";
            for (u32 f = 0; f < frames && says == "equal"; ++f) {
                const StepResult expected = on_host(built, f);
                says = compare(expected, device.result(f));
                device.replay(f);
                if (says == "equal") says = "graph: " + compare(expected, device.result(f));
                if (says == "graph: equal") says = "equal";
            }
            std::printf("%-26s cells %.1f: %s\n", recipe.name, sides, says.c_str());
        }
}

void table(DeviceTimer& timer) {
    std::vector<std::vector<double>> by_stage;
    std::printf("microseconds; must and aim are for `graph`, the median of 200 replays over four frames\n%-31s %9s %8s %8s %7s %7s %5s %5s %5s  %s\n",
                "scene", "tets", "near", "contacts", "eager", "graph", "must", "aim", "MB", "against the host");
    for (const SceneRecipe& recipe : table_scenes) {
        const BuiltScene built = build(recipe);
        DeviceScene device(built, timer);
        const StepResult expected = on_host(built, 0);
        std::string says = compare(expected, device.result(0));
        device.capture();
        const double eager = timer(200, 0, [&](u32 i) { device.step(i % frames); });
        const double graph = device.graph_time(200);
        const std::string after = compare(expected, device.result(0));
        if (says == "equal" && after != "equal") says = "AFTER THE TIMING: " + after;
        by_stage.push_back(device.stage_times(41));
        u64 tets = 0;
        for (const TileOfBody& tile : built.data.tiles) tets += tile.tet_count;
        std::printf("%-31s %9llu %8u %8u %7.1f %7.1f %5.0f %5.0f %5llu  %s%s\n", recipe.name, static_cast<unsigned long long>(tets),
                    expected.status.near_vertices, expected.status.contact_count, eager, graph, recipe.must, recipe.aim,
                    static_cast<unsigned long long>(device.bytes() >> 20), says.c_str(),
                    recipe.must == 0 ? "" : graph <= recipe.aim ? ", AIM MET" : graph <= recipe.must ? ", must met" : ", MISSED");
        std::fflush(stdout);
    }
    std::printf("\nmicroseconds of stages, between events, which add about 1 each\n%-31s", "scene");
    for (const char* name : stage_names) std::printf(" %8s", name);
    for (std::size_t i = 0; i < by_stage.size(); ++i) {
        std::printf("\n%-31s", table_scenes[i].name);
        for (const double time : by_stage[i]) std::printf(" %8.1f", time);
    }
    std::printf("\n");
}

void sweep(DeviceTimer& timer) {
    std::printf("cells, in sides of tiles; microseconds\n");
    for (const double sides : {0.35, 0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4, 2.0, 2.8}) {
        std::printf("%5.2f", sides);
        for (int i = 0; i < 2; ++i) {
            const BuiltScene built = build(table_scenes[i], sides);
            DeviceScene device(built, timer);
            device.capture();
            std::printf(" | %s %8.1f", table_scenes[i].name, device.graph_time(60));
        }
        std::printf("\n");
        std::fflush(stdout);
    }
}

int run(const std::string& what) {
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::fprintf(stderr, "no CUDA device\n");
        return 2;
    }
    cudaDeviceProp properties;
    int driver = 0;
    check_cuda(cudaGetDeviceProperties(&properties, 0));
    check_cuda(cudaDriverGetVersion(&driver));
    std::printf("%s, sm_%d%d, driver for CUDA %d\n", properties.name, properties.major, properties.minor, driver);
    DeviceTimer timer;
    if (what == "--small")
        small(timer);
    else if (what == "--sweep")
        sweep(timer);
    else
        table(timer);
    if (failures)
        std::printf("%d FAILED\n", failures);
    else
        std::printf("all contacts equal\n");
    return failures ? 1 : 0;
}

} // namespace
} // namespace vox::gpu

int main(int argc, char** argv) { return vox::gpu::run(argc > 1 ? argv[1] : ""); }
