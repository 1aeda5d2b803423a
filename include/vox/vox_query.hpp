// vox_query.hpp: vox_query.h for C++20, under the rules of vox.hpp. Every function here stands for the one of
// vox_query.h that its comment names.
#ifndef VOX_VOX_QUERY_HPP
#define VOX_VOX_QUERY_HPP

#include <vox/vox.hpp>
#include <vox/vox_query.h>

namespace vox {
// vox_locator. A copy is one more owner (vox_locator_retain). One that was not taken yet is null: calls fail.
// Questions with lists for an answer return all of it, or write the first ones to `out` and return how many there are.
class locator {
public:
    locator() noexcept = default;
    explicit locator(grid& of) { update(of); }
    locator(const locator& other) noexcept : raw_(other.raw_) {
        if (raw_) (void)vox_locator_retain(raw_); // which fails for null alone
    }
    locator(locator&& other) noexcept : raw_(std::exchange(other.raw_, nullptr)) {}
    locator& operator=(locator other) noexcept { return std::swap(raw_, other.raw_), *this; }
    ~locator() { vox_locator_release(raw_); }
    // Takes over a locator made in C.
    static locator adopt(vox_locator* raw) noexcept { return locator(raw); }
    const vox_locator* get() const noexcept { return raw_; }

    // vox_grid_update_locator
    void update(grid& of) { return of.done(vox_grid_update_locator(of.get(), &raw_)); }
    // vox_locator_get_epoch
    std::uint64_t epoch() const { return detail::filled<std::uint64_t>(vox_locator_get_epoch, raw_); }
    // vox_locator_get_user_data
    std::uint64_t user_data(vox_body body) const {
        return detail::filled<std::uint64_t>(vox_locator_get_user_data, raw_, body);
    }

    // vox_locator_find_point_hits
    std::vector<vox_point_hit> find_point_hits(const points& at, const vox_query_desc& desc = any()) const {
        return detail::collect<vox_point_hit>(static_cast<std::size_t>(at.count), [&](auto... out) {
            return vox_locator_find_point_hits(raw_, &at, &desc, out...);
        });
    }
    std::uint64_t find_point_hits(const points& at, span<vox_point_hit> out, const vox_query_desc& desc = any()) const {
        return detail::filled<std::uint64_t>([&](std::uint64_t* count) {
            return vox_locator_find_point_hits(raw_, &at, &desc, out.data(), out.size(), count);
        });
    }
    // vox_locator_locate: one location a point
    std::vector<vox_location> locate(const points& at, const vox_query_desc& desc = any()) const {
        std::vector<vox_location> found(static_cast<std::size_t>(at.count));
        return locate(at, found, desc), found;
    }
    void locate(const points& at, span<vox_location> out, const vox_query_desc& desc = any()) const {
        if (out.size() < at.count)
            detail::refuse("locate: room for %llu locations, for %llu points", out.size(), at.count);
        detail::check(vox_locator_locate(raw_, &at, &desc, out.data()));
    }
    // vox_locator_find_closest: one hit a point
    std::vector<vox_closest_hit> find_closest(const points& at, const vox_query_desc& desc = any()) const {
        std::vector<vox_closest_hit> hits(static_cast<std::size_t>(at.count));
        return find_closest(at, hits, desc), hits;
    }
    void find_closest(const points& at, span<vox_closest_hit> out, const vox_query_desc& desc = any()) const {
        if (out.size() < at.count)
            detail::refuse("find_closest: room for %llu hits, for %llu points", out.size(), at.count);
        detail::check(vox_locator_find_closest(raw_, &at, &desc, out.data()));
    }
    // vox_locator_find_box_hits
    std::vector<vox_box_hit> find_box_hits(const points& min, const points& max,
                                           const vox_query_desc& desc = any()) const {
        return detail::collect<vox_box_hit>(
            16, [&](auto... out) { return vox_locator_find_box_hits(raw_, &min, &max, &desc, out...); });
    }
    std::uint64_t find_box_hits(const points& min, const points& max, span<vox_box_hit> out,
                                const vox_query_desc& desc = any()) const {
        return detail::filled<std::uint64_t>([&](std::uint64_t* count) {
            return vox_locator_find_box_hits(raw_, &min, &max, &desc, out.data(), out.size(), count);
        });
    }
    // vox_locator_find_ray_hits
    std::vector<vox_ray_hit> find_ray_hits(const points& from, const points& to,
                                           const vox_query_desc& desc = any()) const {
        return detail::collect<vox_ray_hit>(
            16, [&](auto... out) { return vox_locator_find_ray_hits(raw_, &from, &to, &desc, out...); });
    }
    std::uint64_t find_ray_hits(const points& from, const points& to, span<vox_ray_hit> out,
                                const vox_query_desc& desc = any()) const {
        return detail::filled<std::uint64_t>([&](std::uint64_t* count) {
            return vox_locator_find_ray_hits(raw_, &from, &to, &desc, out.data(), out.size(), count);
        });
    }
    // vox_locator_test_rays: 1 or 0 a ray
    std::vector<std::uint8_t> test_rays(const points& from, const points& to,
                                        const vox_query_desc& desc = any()) const {
        std::vector<std::uint8_t> blocked(static_cast<std::size_t>(from.count));
        detail::check(vox_locator_test_rays(raw_, &from, &to, &desc, blocked.data()));
        return blocked;
    }
    // vox_locator_find_tracks
    std::vector<vox_track_piece> find_tracks(const points& from, const points& to,
                                             const vox_query_desc& desc = any()) const {
        return detail::collect<vox_track_piece>(
            16, [&](auto... out) { return vox_locator_find_tracks(raw_, &from, &to, &desc, out...); });
    }
    std::uint64_t find_tracks(const points& from, const points& to, span<vox_track_piece> out,
                              const vox_query_desc& desc = any()) const {
        return detail::filled<std::uint64_t>([&](std::uint64_t* count) {
            return vox_locator_find_tracks(raw_, &from, &to, &desc, out.data(), out.size(), count);
        });
    }
    // vox_locator_find_closest_to_segments: one hit a segment
    std::vector<vox_closest_hit> find_closest_to_segments(const points& from, const points& to,
                                                          const vox_query_desc& desc = any()) const {
        std::vector<vox_closest_hit> hits(static_cast<std::size_t>(from.count));
        detail::check(vox_locator_find_closest_to_segments(raw_, &from, &to, &desc, hits.data()));
        return hits;
    }
    // vox_locator_find_triangle_hits: of triangles that stand still, and of moving ones
    std::vector<vox_triangle_hit> find_triangle_hits(const points& corners,
                                                     const vox_query_desc& desc = any()) const {
        return detail::collect<vox_triangle_hit>(16, [&](auto... out) {
            return vox_locator_find_triangle_hits(raw_, &corners, nullptr, &desc, out...);
        });
    }
    std::vector<vox_triangle_hit> find_triangle_hits(const points& from, const points& to,
                                                     const vox_query_desc& desc = any()) const {
        return detail::collect<vox_triangle_hit>(
            16, [&](auto... out) { return vox_locator_find_triangle_hits(raw_, &from, &to, &desc, out...); });
    }

private:
    explicit locator(vox_locator* raw) noexcept : raw_(raw) {}
    static vox_query_desc any() noexcept { return vox_default_query_desc(); }

    vox_locator* raw_ = nullptr;
};

} // namespace vox

#endif
