// Stages 9 to 11: the few hits of a vertex in order, the rule of shared boundaries, and contacts with their
// weights. Vertices at risk are numbered in ascending order, so this is the canonical order.
#pragma once

#include "exact/float_weights.hpp"
#include "gpu/scene.hpp"

namespace vox::gpu {

// Over vertices at risk.
struct KeepHits {
    SceneArrays s;

    VOX_HD void operator()(u32 risk) const {
        HitOfVertex* hits = s.hits + s.hits_begin[risk];
        const u32 count = s.hits_of[risk];
        for (u32 i = 1; i < count; ++i)
            for (u32 k = i; k > 0 && hits[k] < hits[k - 1]; --k) {
                const HitOfVertex hit = hits[k];
                hits[k] = hits[k - 1];
                hits[k - 1] = hit;
            }
        // Keeps each body's hits in an interior, or else its first one.
        u32 kept = 0;
        for (u32 begin = 0, end = 0; begin < count; begin = end) {
            bool any_interior = false;
            for (; end < count && body_of(hits[end]) == body_of(hits[begin]); ++end)
                any_interior = any_interior || is_interior(hits[end]);
            if (!any_interior) hits[kept++] = hits[begin];
            for (u32 i = begin; any_interior && i < end; ++i)
                if (is_interior(hits[i])) hits[kept++] = hits[i];
        }
        s.kept_of[risk] = kept;
    }
};

// Over vertices at risk, and over scenes and one more, after a sum over kept_of.
struct WriteContacts {
    SceneArrays s;

    VOX_HD void operator()(u32 i) const {
        const u32 faults = find_faults();
        if (i <= s.scene_count) begin_scene(i, faults);
        if (i >= s.vertex_risk[s.vertex_count] || faults != 0) return;
        const u32 v = s.risk_vertex[i], body = s.vertex_body[v];
        for (u32 k = 0; k < s.kept_of[i]; ++k)
            write(s.bodies[body].id, v, s.bodies[body].first_vertex, s.hits[s.hits_begin[i] + k],
                  s.kept_begin[i] + k);
    }

private:
    VOX_HD u32 find_faults() const {
        if (s.status->non_finite_vertex != none)
            return non_finite_position; // what there is no room for may be its fault
        return (s.cell_begin[s.slots()] > s.point_room ? too_many_points : 0) |
               (s.status->needed_findings > s.finding_room ? too_many_findings : 0) |
               (s.kept_begin[s.vertex_count] > s.contact_room ? too_many_contacts : 0);
    }
    VOX_HD void begin_scene(u32 scene, u32 faults) const {
        const u32 body = s.first_body[scene];
        const u32 vertex = body < s.body_count ? s.bodies[body].first_vertex : s.vertex_count;
        s.contact_begin[scene] = faults ? 0 : s.kept_begin[s.vertex_risk[vertex]];
        if (scene < s.scene_count) return;
        StepStatus& status = *s.status;
        status.contact_count = faults ? 0 : s.kept_begin[s.vertex_count];
        status.faults = faults;
        status.needed_points = s.cell_begin[s.slots()];
        status.needed_contacts = s.kept_begin[s.vertex_count];
        status.near_vertices = s.vertex_risk[s.vertex_count];
    }
    VOX_HD void write(u32 id, u32 vertex, u32 first_vertex, HitOfVertex hit, u32 to) const {
        const BodyOfScene& b = s.bodies[body_of(hit)];
        const Tet tet = s.tets[static_cast<std::size_t>(b.first_tet) + tet_of(hit)];
        const auto corner = [&](int k) { return s.exact(b.first_vertex + tet.v[k]); };
        s.contacts[to] = {id, vertex - first_vertex, b.id, tet_of(hit)};
        s.interiors[to] = is_interior(hit);
        if (!weigh_as_floats(s.exact(vertex), corner, s.weights[to])) atomic_add(&s.status->rough_weights, 1);
    }
};

} // namespace vox::gpu
