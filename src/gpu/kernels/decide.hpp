// Stages 6 and 8: findings that single precision left open, exactly; hits to their vertices.
#pragma once

#include "exact/predicates.hpp"
#include "exact/volume_sign.hpp"
#include "gpu/scene.hpp"

namespace vox::gpu {

// A finding that single precision left open, as the exact predicates see it. Positions are read again for an
// exact sign, as keeping them takes more registers than there are.
struct OpenFinding {
    const float* positions;
    u32 point, corner[4];
    u32 signs = 0; // how many were computed exactly

    VOX_HD Vec3d at(u32 vertex) const {
        const float* p = positions + 3 * static_cast<std::size_t>(vertex);
        return {double{p[0]}, double{p[1]}, double{p[2]}};
    }
    VOX_HD int operator()(const BoundedVolume&, int i) {
        ++signs;
        return sign_of_volume([&](int k) {
            return at(k == i   ? point
                      : k == 0 ? corner[0]
                      : k == 1 ? corner[1]
                      : k == 2 ? corner[2]
                               : corner[3]);
        });
    }
};

// Over findings: which are hits, and how many its vertex has.
struct Decide {
    SceneArrays s;

    VOX_HD void operator()(u32 f) const {
        const TileFinding finding = s.findings[f];
        bool interior = true;
        if (!finding.certain) {
            const TileOfBody tile = s.tiles[finding.tile];
            const u32 corners = s.corners[tile.first_tet + finding.place];
            OpenFinding open{s.positions, s.risk_vertex[finding.risk], {}};
            for (u32 k = 0; k < 4; ++k) open.corner[k] = s.vertex_of_tile(tile, corners >> (8 * k) & 255);
            const Containment where =
                locate_by(open.at(open.point), open.at(open.corner[0]), open.at(open.corner[1]),
                          open.at(open.corner[2]), open.at(open.corner[3]), open);
            if (open.signs) atomic_add(&s.status->exact_tests, open.signs);
            s.finding_place[f] = 0;
            if (where == Containment::outside || where == Containment::degenerate) return;
            interior = where == Containment::interior;
        }
        s.finding_place[f] = (atomic_add(&s.hits_of[finding.risk], 1) + 1) << 1 | u32{interior};
    }
};

// Over findings, after a sum over hits_of.
struct PlaceHits {
    SceneArrays s;

    VOX_HD void operator()(u32 f) const {
        const u32 place = s.finding_place[f];
        if (place == 0) return;
        const TileFinding finding = s.findings[f];
        const TileOfBody tile = s.tiles[finding.tile];
        const u32 tet = s.tile_tets[tile.first_tet + finding.place];
        s.hits[s.hits_begin[finding.risk] + (place >> 1) - 1] = hit_of(tile.body, tet, (place & 1) != 0);
    }
};

} // namespace vox::gpu
