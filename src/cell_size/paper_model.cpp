#include "cell_size/paper_model.hpp"

#include "base/error.hpp"

#include <cinttypes>
#include <cmath>

namespace vox {

PaperModel::PaperModel(const CellSizeScene& scene, const vox_cell_size_desc& desc)
    : p_nc_(desc.p_nc), cost_ratio_(desc.cost_ratio) {
    const vox_geometry& stats = scene.geometry.stats;
    const double s = stats.mean_edge, area = stats.mean_facet_area;
    if (stats.tets == 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("no tetrahedra: %" PRIu64 " vertices alone give no cell size", stats.vertices));
    if (!(s > 0) || !(area > 0))
        throw Error(
            VOX_ERROR_INVALID_ARGUMENT,
            format("%" PRIu64 " tets of no size: mean edge %g, mean facet area %g", stats.tets, s, area));
    s_ = s;
    k_ = (1 - p_nc_) * cost_ratio_ * 1.5 * std::sqrt(3.0) * (s * s / area);
    if (!(k_ >= 1e-290 && k_ <= 1e290))
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("p_nc %.9g, cost_ratio %g, mean edge %g and mean "
                                                       "facet area %g are beyond the cost model: its "
                                                       "k is %g, expected 1e-290 to 1e290",
                                                       p_nc_, cost_ratio_, s, area, k_));
}

// dz/dx = 0 (Eq. 8) is 4 x^3 - x^2 = c with c = 3 p_nc / k. With x = 1/12 + w/6 it is 4 w^3 - 3 w = 1 + 216
// c, and 4 cosh^3 - 3 cosh is cosh of the triple angle, so there is one root with w >= 1.
double PaperModel::best_x() const noexcept {
    const double c = 3 * p_nc_ / k_;
    return 1.0 / 12 + std::cosh(std::acosh(1 + 216 * c) / 3) / 6;
}

vox_cost_sample PaperModel::minimum() const { return {best_x() * s_, cost(best_x())}; }

// In x, so that no unit of length changes the result. z falls before the minimum and rises after it, without
// bound, so the range is only there to keep numbers finite.
CellSizeRange PaperModel::zone(double loss) const {
    const vox_cost_sample best{best_x(), cost(best_x())};
    const auto of_x = [this](double x) { return cost(x); };
    const CellSizeRange zone = zone_around(best, (1 + loss) * best.cost, of_size(of_x),
                                           {best.cell_size * 1e-100, best.cell_size * 1e100});
    return {zone.min * s_, zone.max * s_};
}

CostTerms PaperModel::terms(double cell_size) const {
    const double x = cell_size / s_, side = 1 / x + 2, voxels = side * side * side;
    CostTerms terms;
    terms.add("visit a cell", p_nc_ * voxels, 1);
    terms.add("test a particle", voxels * k_ * x * x / cost_ratio_, cost_ratio_);
    return terms;
}

} // namespace vox
