// Floors, which no method can beat: F1, one pass over all positions for their minimum and maximum, and F2,
// the box of every tetrahedron. Four floats at a time in the vector types of GCC and clang.
#include "entrant.hpp"

#include <cstring>
#include <limits>

namespace bench {

extern float floor_result[8]; // seen from outside, so that the compiler cannot leave the work out
float floor_result[8];

namespace {

typedef float Four __attribute__((vector_size(16)));

Four load(const float* p) {
    Four v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
Four smaller(Four a, Four b) { return a < b ? a : b; }
Four larger(Four a, Four b) { return a > b ? a : b; }
void keep(Four low, Four high) {
    std::memcpy(floor_result, &low, sizeof low);
    std::memcpy(floor_result + 4, &high, sizeof high);
}

class Floor : public Entrant {
public:
    void setup(const Scene& scene) override { scene_ = &scene; }
    std::vector<vox_contact> contacts() override { return {}; }

protected:
    const Scene* scene_ = nullptr;
};

class PositionsFloor final : public Floor {
    void step() override {
        constexpr float inf = std::numeric_limits<float>::infinity();
        constexpr Four infinity = {inf, inf, inf, inf};
        for (const Body& body : scene_->bodies) {
            // Four positions are three vectors; which lane is which axis does not matter for the time.
            Four low[3] = {infinity, infinity, infinity};
            Four high[3] = {-infinity, -infinity, -infinity};
            const std::size_t floats = 3 * body.vertex_count();
            std::size_t i = 0;
            for (; i + 12 <= floats; i += 12)
                for (std::size_t k = 0; k < 3; ++k) {
                    const Four v = load(&body.positions[i + 4 * k]);
                    low[k] = smaller(v, low[k]);
                    high[k] = larger(v, high[k]);
                }
            for (; i + 3 <= floats; i += 3) {
                const Four v = load(&body.positions[i]);
                low[0] = smaller(v, low[0]);
                high[0] = larger(v, high[0]);
            }
            keep(smaller(smaller(low[0], low[1]), low[2]), larger(larger(high[0], high[1]), high[2]));
        }
    }
};

class TetBoxesFloor final : public Floor {
    void step() override {
        for (const Body& body : scene_->bodies) {
            const float* positions = body.positions.data();
            Four lows = {}, highs = {};
            for (std::size_t t = 0; t < body.tets.size(); t += 4) {
                const std::uint32_t* v = &body.tets[t];
                const Four a = load(positions + 3 * std::size_t(v[0]));
                const Four b = load(positions + 3 * std::size_t(v[1]));
                const Four c = load(positions + 3 * std::size_t(v[2]));
                const Four d = load(positions + 3 * std::size_t(v[3]));
                lows += smaller(smaller(a, b), smaller(c, d));
                highs += larger(larger(a, b), larger(c, d));
            }
            keep(lows, highs);
        }
    }
};

} // namespace

std::vector<EntrantMaker> floors() {
    return {{"F1 positions", Kind::floor, [] { return std::make_unique<PositionsFloor>(); }},
            {"F2 tet boxes", Kind::floor, [] { return std::make_unique<TetBoxesFloor>(); }}};
}

} // namespace bench
