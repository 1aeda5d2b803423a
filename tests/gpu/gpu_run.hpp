// Scenes on the host's loops, and what the library finds in them.
#pragma once

#include "exact/predicates.hpp"
#include "gpu/host_backend.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/upload.hpp"

#include "support/suite.h"

#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vox::test {

// A contact with all that is known of it.
struct WeighedContact {
    vox_contact contact;
    std::uint8_t interior;
    std::array<float, 4> weights;

    bool operator==(const WeighedContact& other) const {
        return std::memcmp(&contact, &other.contact, sizeof contact) == 0 && interior == other.interior &&
               std::memcmp(&weights, &other.weights, sizeof weights) == 0;
    }
};
using WeighedContacts = std::vector<WeighedContact>;

inline const gpu::HostOrder orders[] = {{1, 0, 1, 0, 1, true}, // ascending
                                        {31, 31, 4294967291u, 12345, 1, true},
                                        {13, 7, 1000003, 7, 3, true}}; // shared by three workers

class HostScenes {
public:
    explicit HostScenes(const std::vector<vox_grid*>& grids, const gpu::HostOrder& order = orders[0],
                        double cell_size = 0, const gpu::StepRooms& rooms = {})
        : data_(gpu::read_grids(std::vector<const vox_grid*>(grids.begin(), grids.end()), cell_size)),
          pipeline_(gpu::make_host_backend(order), data_, rooms, UINT64_MAX), grids_(grids) {}

    // Binds the positions of all meshes as they are now, packed.
    void bind() {
        packed_.assign(3 * std::size_t{data_.vertex_count}, 0);
        for (std::size_t scene = 0; scene < grids_.size(); ++scene)
            for (gpu::u32 b = data_.first_body[scene]; b < data_.first_body[scene + 1]; ++b) {
                const gpu::BodyOfScene& body = data_.bodies[b];
                vox_body_info info;
                info.struct_size = sizeof info;
                ck_ok(vox_body_get_info(grids_[scene], body.id, &info));
                const std::size_t stride = info.positions.byte_stride ? info.positions.byte_stride : 12;
                for (gpu::u32 v = 0; v < body.vertex_count; ++v)
                    std::memcpy(&packed_[3 * (std::size_t{body.first_vertex} + v)],
                                static_cast<const char*>(info.positions.data) + v * stride, 12);
            }
        pipeline_.bind(packed_.data(), 12);
    }

    gpu::StepStatus step() {
        pipeline_.step(nullptr);
        const gpu::StepStatus status = pipeline_.finish();
        const char* fault = gpu::take_phase_fault();
        ck_assert_msg(!fault, "%s", fault);
        ck_assert_msg(gpu::guards_hold(pipeline_.backend()), "something was written around an array");
        return status;
    }

    // Steps until there is room for everything.
    gpu::StepStatus step_completely() {
        bind();
        gpu::StepStatus status = step();
        for (int again = 0; again < 4 && status.faults; ++again) status = step();
        ck_assert_uint_eq(status.faults, 0);
        return status;
    }

    WeighedContacts contacts(std::size_t scene) const {
        const gpu::SceneArrays& s = pipeline_.arrays();
        WeighedContacts all;
        for (gpu::u32 i = s.contact_begin[scene]; i < s.contact_begin[scene + 1]; ++i) {
            WeighedContact c{s.contacts[i], s.interiors[i], {}};
            std::memcpy(&c.weights, s.weights[i], sizeof c.weights);
            all.push_back(c);
        }
        return all;
    }

    gpu::Pipeline& pipeline() { return pipeline_; }
    const gpu::SceneData& data() const { return data_; }
    std::vector<float>& packed() { return packed_; }

private:
    gpu::SceneData data_;
    gpu::Pipeline pipeline_;
    std::vector<vox_grid*> grids_;
    std::vector<float> packed_;
};

// The contacts of the grid's last step, with weights by integers (exact/predicates.hpp).
inline WeighedContacts expected_contacts(vox_grid* grid) {
    const auto point = [grid](vox_body id, std::uint32_t v) {
        vox_body_info info;
        info.struct_size = sizeof info;
        ck_ok(vox_body_get_info(grid, id, &info));
        Vec3f p;
        const std::size_t stride = info.positions.byte_stride ? info.positions.byte_stride : sizeof p;
        std::memcpy(&p, static_cast<const char*>(info.positions.data) + v * stride, sizeof p);
        return Vec3d(p);
    };
    WeighedContacts all;
    std::vector<std::uint32_t> tets;
    vox_body tets_of = VOX_NULL_BODY;
    const vox_contact_view view = contacts_of(grid);
    for (std::uint64_t i = 0; i < view.count; ++i) {
        const vox_contact& c = view.data[i];
        if (std::exchange(tets_of, c.body_b) != c.body_b) {
            std::uint64_t count = 0;
            ck_ok(vox_mesh_get_tets(grid, c.body_b, nullptr, nullptr, 0, &count));
            tets.resize(4 * count);
            ck_ok(vox_mesh_get_tets(grid, c.body_b, tets.data(), nullptr, count, &count));
        }
        const std::uint32_t* v = &tets[4 * std::size_t{c.tet}];
        const std::array<double, 4> weights =
            exact_weights(point(c.body_a, c.vertex), point(c.body_b, v[0]), point(c.body_b, v[1]),
                          point(c.body_b, v[2]), point(c.body_b, v[3]));
        WeighedContact expected{c, view.interiors[i], {}};
        for (std::size_t k = 0; k < 4; ++k) expected.weights[k] = static_cast<float>(weights[k]) + 0.0f;
        all.push_back(expected);
    }
    return all;
}

inline std::string text_of(const WeighedContact& c) {
    char text[200];
    std::snprintf(text, sizeof text, "vertex %u of %x in tet %u of %x, %s, weights %a %a %a %a",
                  c.contact.vertex, c.contact.body_a, c.contact.tet, c.contact.body_b,
                  c.interior ? "inside" : "on its boundary", double{c.weights[0]}, double{c.weights[1]},
                  double{c.weights[2]}, double{c.weights[3]});
    return text;
}

// All fields of all contacts. `rough`: weights may differ, as tetrahedra are too flat.
inline void check_contacts(WeighedContacts expected, WeighedContacts found, const char* name,
                           bool rough = false) {
    for (WeighedContacts* all : {&expected, &found})
        for (WeighedContact& c : *all)
            if (rough) c.weights = {};
    for (std::size_t i = 0; i < expected.size() && i < found.size(); ++i)
        ck_assert_msg(expected[i] == found[i], "%s: contact %zu is %s, expected %s", name, i,
                      text_of(found[i]).c_str(), text_of(expected[i]).c_str());
    ck_assert_msg(expected.size() == found.size(), "%s: %zu contacts, expected %zu", name, found.size(),
                  expected.size());
}

// The kernels find in each order what the grids' steps do. Returns the status of the last one.
inline gpu::StepStatus check_against_grids(const std::vector<vox_grid*>& grids, const char* name,
                                           double cell_size = 0) {
    gpu::StepStatus status{};
    for (vox_grid* grid : grids) ck_ok(vox_grid_step(grid));
    for (const gpu::HostOrder& order : orders) {
        HostScenes scenes(grids, order, cell_size);
        status = scenes.step_completely();
        for (std::size_t i = 0; i < grids.size(); ++i)
            check_contacts(expected_contacts(grids[i]), scenes.contacts(i), name, status.rough_weights != 0);
    }
    return status;
}

} // namespace vox::test
