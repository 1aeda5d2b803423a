// vox through its C interface, as a user would call it: a grid with constraints and all that its step does,
// the same as a machine without AVX-512 runs it, the default grid, which finds contacts alone, and the
// paper's algorithm, which does so too.
#include "entrant.hpp"
#include "scenes/counters.h"
#include "scenes/engines.h"

#include "base/simd.hpp"
#include "program.hpp"
#include "timing.h"

#include <vox/vox.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace bench {

const std::string subject_name = "vox";
const std::string avx2_name = "vox AVX2";
const std::string contacts_name = "vox contacts";
const std::string reference_name = "vox reference";

namespace {

const std::string* const names[] = {&subject_name, &contacts_name, &avx2_name, &reference_name};

// Cell sizes of the sweep, in mean edges. The reference engine's best ones lie between 1 and 1.8.
constexpr double sweep_factors[] = {0.85, 1.0, 1.2, 1.45, 1.75, 2.1, 2.5};

class VoxEntrant final : public Entrant {
public:
    explicit VoxEntrant(const std::string& name)
        : sweep_(name == reference_name), is_limited_(name == avx2_name) {
        const vox_grid_desc desc = grid_desc(name);
        must(vox_grid_create(&desc, &grid_));
    }
    ~VoxEntrant() override { vox_grid_destroy(grid_); }
    VoxEntrant(const VoxEntrant&) = delete;
    VoxEntrant& operator=(const VoxEntrant&) = delete;

    void setup(const Scene& scene) override {
        for (const Body& body : scene.bodies) {
            const vox_mesh_desc desc = body.desc();
            meshes_.emplace_back();
            must(vox_mesh_insert(grid_, &desc, &meshes_.back()));
        }
    }

    void tune(const Scene& scene) override {
        if (!sweep_) return;
        double best_size = 0, best_seconds = std::numeric_limits<double>::infinity();
        for (double factor : sweep_factors) {
            must(vox_grid_set_cell_size(grid_, factor * scene.mean_edge));
            for (int repeat = 0; repeat < 3; ++repeat) {
                const double seconds = seconds_of([&] { step(); });
                if (seconds >= best_seconds) continue;
                best_seconds = seconds;
                best_size = factor * scene.mean_edge;
            }
        }
        must(vox_grid_set_cell_size(grid_, best_size));
    }

    void step() override {
        const vox::simd::Level level = vox::simd::level();
        if (is_limited_) vox::simd::force_level(std::min(level, vox::simd::Level::avx2));
        must(vox_grid_step(grid_));
        if (is_limited_) vox::simd::force_level(level);
    }

    std::vector<vox_contact> contacts() override {
        vox_contact_view view;
        must(vox_grid_get_contacts(grid_, &view));
        std::vector<vox_contact> contacts(view.data, view.data + view.count);
        const auto body = [&](vox_body mesh) { // ids ascend as bodies do
            return static_cast<vox_body>(std::ranges::lower_bound(meshes_, mesh) - meshes_.begin());
        };
        for (vox_contact& contact : contacts) {
            contact.body_a = body(contact.body_a);
            contact.body_b = body(contact.body_b);
        }
        return contacts;
    }

    std::size_t bytes() const override {
        grid_counts counters{};
        counters = counters_of(grid_);
        return counters.bytes;
    }

    double cell_size() const override {
        vox_grid_info info;
        info.struct_size = sizeof info;
        must(vox_grid_get_info(grid_, &info));
        return info.cell_size;
    }

private:
    bool sweep_;      // try cell sizes and keep the fastest one
    bool is_limited_; // to AVX2
    vox_grid* grid_ = nullptr;
    std::vector<vox_body> meshes_;
};

} // namespace

std::vector<EntrantMaker> vox_entrants() {
    std::vector<EntrantMaker> makers;
    for (const std::string* name : names)
        makers.push_back({*name, Kind::vox, [name] { return std::make_unique<VoxEntrant>(*name); }});
    return makers;
}

vox_grid_desc grid_desc(const std::string& vox_entrant) {
    vox_grid_desc desc = vox_default_grid_desc();
    if (vox_entrant == subject_name || vox_entrant == avx2_name)
        desc.flags = VOX_GRID_CONSTRAINTS;
    else if (vox_entrant == reference_name)
        use_engine(&desc, ENGINE_REFERENCE);
    else if (vox_entrant != contacts_name)
        throw std::invalid_argument(vox_entrant + " is no entrant of vox");
    return desc;
}

} // namespace bench
