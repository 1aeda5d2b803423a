// What the fast engine keeps to itself, to be drawn: the one file here that looks behind the public headers.
#include "playground.hpp"

#include "grid/grid.hpp"

#include <algorithm>
#include <limits>

using namespace play;

namespace {

void put_tiles(playground& play) {
    for (const Body& body : play.bodies) {
        const vox::Tiles* made = play.grid->mesh(body.mesh).tiles_if_made();
        if (!made) continue; // before the first step
        for (const vox::Tile& tile : made->tiles) {
            float box[6];
            std::fill(box, box + 3, std::numeric_limits<float>::infinity());
            std::fill(box + 3, box + 6, -std::numeric_limits<float>::infinity());
            for (std::uint32_t i = 0; i < tile.vertex_count; ++i)
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const float x = body.view.grid_positions[3 * made->vertices[tile.first_vertex + i] + c];
                    box[c] = std::min(box[c], x);
                    box[3 + c] = std::max(box[3 + c], x);
                }
            if (tile.tet_count > 0) play.boxes.insert(play.boxes.end(), box, box + 6);
        }
    }
}

void put_windows(playground& play) {
    for (const vox::fast::BodyWindow& body : play.grid->fast_engine().windows().of) {
        if (!body.bins) continue;
        const auto& windows = body.bins->windows;
        for (std::uint32_t w = body.root; w < windows[body.root].end && w < windows.size(); ++w)
            if (windows[w].count > 0) {
                const auto& box = windows[w].box;
                play.boxes.insert(play.boxes.end(),
                                  {box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]});
            }
    }
}

} // namespace

const float* play_boxes(playground* play, uint32_t what, uint32_t* out_count) {
    play->boxes.clear();
    const vox_result result = guard([&] { what == 0 ? put_tiles(*play) : put_windows(*play); });
    *out_count = result == VOX_OK ? static_cast<std::uint32_t>(play->boxes.size() / 6) : 0;
    return play->boxes.data();
}
