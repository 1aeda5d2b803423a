// vox_surface.hpp: vox_surface.h for C++20, under the rules of vox.hpp. Every function here stands for the one
// of vox_surface.h that its comment names. Experimental, as that is.
#ifndef VOX_VOX_SURFACE_HPP
#define VOX_VOX_SURFACE_HPP

#include <vox/vox_cell_size.hpp>
#include <vox/vox_surface.h>

namespace vox {
// vox_partner_lists: the partners of feature first + i are lists[i]. It lives as long as that, which nothing checks.
class partner_lists {
public:
    explicit partner_lists(const vox_partner_lists& raw) noexcept : raw_(raw) {}
    std::uint64_t first() const noexcept { return raw_.first; }
    std::size_t size() const noexcept { return static_cast<std::size_t>(raw_.count); } // features with a list
    span<const std::uint32_t> operator[](std::size_t i) const noexcept {
        const std::uint64_t begin = raw_.offsets[i];
        return {raw_.partners + begin, static_cast<std::size_t>(raw_.offsets[i + 1] - begin)};
    }
    span<const std::uint64_t> offsets() const noexcept { return {raw_.offsets, size() + 1}; }
    span<const std::uint32_t> partners() const noexcept {
        return {raw_.partners, static_cast<std::size_t>(raw_.offsets[size()])};
    }

private:
    vox_partner_lists raw_;
};

// vox_surface. Move-only; its destructor is vox_surface_destroy. One that was moved from is null: calls fail. What it
// hands out as spans and lists lives as vox_surface.h says.
class surface {
public:
    // vox_surface_create
    explicit surface(const vox_surface_desc& desc) : surface(detail::filled<vox_surface*>(vox_surface_create, &desc)) {}
    // The same of faces, three vertices each; their edges follow from them.
    surface(std::uint64_t vertex_count, span<const std::uint32_t> faces) : surface(desc_of(vertex_count, faces)) {}
    // Takes over a surface made in C.
    static surface adopt(vox_surface* raw) { return surface(raw); }
    vox_surface* get() noexcept { return surface_.get(); }
    const vox_surface* get() const noexcept { return surface_.get(); }

    // vox_surface_get_features: the vertices of all edges or faces, one after the other
    span<const std::uint32_t> features(vox_feature feature) const& {
        const auto view = detail::filled<vox_feature_view>(vox_surface_get_features, get(), feature);
        return {view.vertices, static_cast<std::size_t>(view.count) * (feature == VOX_FEATURE_EDGE ? 2 : 3)};
    }
    void features(vox_feature) const&& = delete;
    // vox_surface_move
    void move(const vox_motion& motion) { detail::check(vox_surface_move(get(), &motion)); }
    // The same, standing still, and from one place to another. Positions are what vox::points takes, and are copied.
    void move(const points& at, double radius = 0, std::uint32_t flags = 0) {
        return moved(at, nullptr, radius, flags);
    }
    void move(const points& from, const points& to, double radius = 0, std::uint32_t flags = 0) {
        return moved(from, &to, radius, flags);
    }
    // vox_surface_find_pairs
    partner_lists find_pairs(vox_feature a, vox_feature b, std::uint64_t first = 0,
                             std::uint64_t count = std::numeric_limits<std::uint64_t>::max()) & {
        return partner_lists(detail::filled<vox_partner_lists>(vox_surface_find_pairs, get(), a, b, first, count));
    }
    // vox_surface_find_crossings
    span<const vox_crossing> find_crossings() & { return all<vox_crossing_view>(vox_surface_find_crossings, get()); }
    // vox_surface_find_proximities
    span<const vox_proximity> find_proximities(vox_feature a, vox_feature b, double distance) & {
        return all<vox_proximity_view>(vox_surface_find_proximities, get(), a, b, distance);
    }
    // vox_surface_find_clearances; `out` has room for a number for each vertex.
    void find_clearances(double max_distance, span<double> out) {
        detail::check(vox_surface_find_clearances(get(), max_distance, out.data()));
    }
    // vox_surface_find_safe_step
    vox_safe_step find_safe_step(const vox_impact_desc& desc = vox_default_impact_desc()) {
        return detail::filled<vox_safe_step>(vox_surface_find_safe_step, get(), &desc);
    }
    // vox_surface_find_impacts
    span<const vox_impact> find_impacts(vox_feature a, vox_feature b,
                                        const vox_impact_desc& desc = vox_default_impact_desc()) & {
        return all<vox_impact_view>(vox_surface_find_impacts, get(), a, b, &desc);
    }
    // vox_surface_set_cell_size
    void set_cell_size(double size) { detail::check(vox_surface_set_cell_size(get(), size)); }
    // vox_surface_suggest_cell_size
    vox_cell_size_result suggest_cell_size(vox_feature a, vox_feature b) {
        return detail::filled<vox_cell_size_result>(vox_surface_suggest_cell_size, get(), a, b);
    }
    // vox_surface_get_counters
    span<const vox_counter> counters() const& { return all<vox_counter_view>(vox_surface_get_counters, get()); }
    void counters() const&& = delete;

private:
    struct deleter {
        void operator()(vox_surface* raw) const noexcept { vox_surface_destroy(raw); }
    };
    explicit surface(vox_surface* raw) noexcept : surface_(raw) {}

    static vox_surface_desc desc_of(std::uint64_t vertex_count, span<const std::uint32_t> faces) {
        if (faces.size() % 3 != 0) detail::refuse("surface: %llu indices are not three for each face", faces.size());
        vox_surface_desc desc = vox_default_surface_desc();
        desc.vertex_count = vertex_count;
        desc.faces = faces.data();
        desc.face_count = faces.size() / 3;
        return desc;
    }
    template <class V, class... A>
    static span<std::remove_pointer_t<decltype(V::data)>> all(A... call) {
        const V view = detail::filled<V>(call...);
        return {view.data, static_cast<std::size_t>(view.count)};
    }
    void moved(const points& from, const points* to, double radius, std::uint32_t flags) {
        vox_motion motion = vox_default_motion();
        motion.flags = flags;
        motion.from = from;
        if (to) motion.to = *to;
        motion.radius = radius;
        detail::check(vox_surface_move(get(), &motion));
    }
    std::unique_ptr<vox_surface, deleter> surface_;
};

} // namespace vox

#endif
