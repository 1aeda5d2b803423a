// vox.hpp: vox.h for C++20, header only; docs/cpp.md shows how it is used.
//
// Every function here stands for the one of vox.h that its comment names, and vox.h says what that does: units, errors,
// threads, what ends a view. A const member reads, any other changes, as a const vox_grid does. Structs and enumerators
// are those of vox.h. What is added:
//   Errors     A call that fails throws vox::error. A std::vector throws std::bad_alloc.
//   Lifetime   Grids are released by their destructors. Temporaries are not borrowed: such calls do not compile.
//   Callables  What a callable throws passes through to the caller, but for a log's exceptions, which are dropped.
#ifndef VOX_VOX_HPP
#define VOX_VOX_HPP

#include <vox/vox.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <memory_resource>
#include <new>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

// Eigen maps of arrays: where Eigen was included before this header, or VOX_HPP_EIGEN asks for it.
#if defined(VOX_HPP_EIGEN) && __has_include(<Eigen/Core>)
#include <Eigen/Core>
#endif

namespace vox {

// ---- errors -------------------------------------------------------------------------------------

// A failed call: its result and the text of vox_last_error().
class error : public std::exception {
public:
    // The failure that this thread's vox_last_error() describes.
    explicit error(vox_result result) noexcept : error(result, vox_last_error()) {}
    error(vox_result result, const char* text) noexcept : result_(result), text_(copy_of(text)) {}
    error(const error& other) noexcept
        : std::exception(other), result_(other.result_), text_(copy_of(other.text_.get())) {}
    error& operator=(const error& other) noexcept {
        result_ = other.result_;
        text_ = copy_of(other.text_.get());
        return *this;
    }
    ~error() override = default;
    vox_result result() const noexcept { return result_; }
    const char* what() const noexcept override { return text_ ? text_.get() : vox_result_string(result_); }

private:
    // Null without memory: then the result's name is the text.
    static std::unique_ptr<char[]> copy_of(const char* text) noexcept {
        const std::size_t size = text ? std::strlen(text) + 1 : 0;
        std::unique_ptr<char[]> copy(size > 1 ? new (std::nothrow) char[size] : nullptr);
        if (copy) std::memcpy(copy.get(), text, size);
        return copy;
    }
    vox_result result_;
    std::unique_ptr<char[]> text_;
};

using std::span;

namespace detail {

inline void check(vox_result result) {
    if (result != VOX_OK) throw error(result);
}

// A failure of this header's own, with its numbers.
template <class... N>
[[noreturn]] void refuse(vox_result result, const char* format, N... numbers) {
    char text[256];
    std::snprintf(text, sizeof text, format, static_cast<unsigned long long>(numbers)...);
    throw error(vox_fail(result, text));
}
template <class... N>
[[noreturn]] void refuse(const char* format, N... numbers) {
    refuse(VOX_ERROR_INVALID_ARGUMENT, format, numbers...);
}

// Keeps what a callable throws, since no exception may cross the library, until the call has returned.
class catcher {
public:
    // False if `call` threw, now or before; then it is not run again.
    template <class F>
    bool run(F&& call) noexcept {
        if (thrown_) return false;
        try {
            call();
        } catch (...) {
            thrown_ = std::current_exception();
        }
        return !thrown_;
    }
    // Also keeps what another has caught, which then has nothing; the first exception stays.
    void take(catcher& other) noexcept {
        std::exception_ptr theirs = std::exchange(other.thrown_, nullptr);
        if (!thrown_) thrown_ = std::move(theirs);
    }
    void rethrow() {
        if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    }

private:
    std::exception_ptr thrown_;
};

// A callable for a function pointer's `user`, and what it has thrown.
template <class F>
struct called_back {
    F& call;
    catcher caught{};
};

// What a function fills: zero, but for a struct_size.
template <class T>
T sized() noexcept {
    T value{};
    if constexpr (requires { value.struct_size; }) value.struct_size = static_cast<std::uint32_t>(sizeof value);
    return value;
}

// A call that ends with where to write one value: that value.
template <class T, class F, class... A>
T filled(F&& call, A... arguments) {
    T value = sized<T>();
    check(call(arguments..., &value));
    return value;
}

// A call that ends with room for several values, and where to write how many there are: all of them. There is room for
// `guess` of them at first.
template <class T, class F, class... A>
std::vector<T> collect(std::size_t guess, F&& call, A... arguments) {
    std::vector<T> found(guess);
    std::uint64_t count = 0;
    check(call(arguments..., found.data(), found.size(), &count));
    if (count > found.size()) {
        found.resize(static_cast<std::size_t>(count));
        check(call(arguments..., found.data(), found.size(), &count));
    }
    found.resize(static_cast<std::size_t>(count));
    return found;
}

} // namespace detail

// ---- what is passed in --------------------------------------------------------------------------

// What an array's elements are made of: `count` numbers of a type, of which a position uses the first three. Specialise
// it for a vector type of your own; numbers, arrays, std::array, and vectors like those of Eigen and glm are known.
template <class E>
struct element {};
template <class E>
requires std::is_arithmetic_v<E>
struct element<E> {
    using number = E;
    static constexpr std::size_t count = 1;
};
template <class E, std::size_t N>
struct element<E[N]> {
    using number = std::remove_cv_t<E>;
    static constexpr std::size_t count = N;
};
template <class E, std::size_t N>
struct element<std::array<E, N>> {
    using number = E;
    static constexpr std::size_t count = N;
};
template <class E>
requires(E::SizeAtCompileTime > 1) struct element<E> { // Eigen
    using number = typename E::Scalar;
    static constexpr std::size_t count = static_cast<std::size_t>(E::SizeAtCompileTime);
};
template <class E>
requires(E::length() > 1) struct element<E> { // glm
    using number = typename E::value_type;
    static constexpr std::size_t count = static_cast<std::size_t>(E::length());
};

namespace detail {

template <class R>
using element_of = std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<const R&>()))>>;
template <class R>
using number_of = typename element<element_of<R>>::number;

// A matrix that lies in memory, like Eigen's.
template <class R>
concept matrix = requires(const R& range) {
    typename R::Scalar;
    range.rowStride();
};

template <class N>
inline constexpr bool is_real = std::is_same_v<N, float> || std::is_same_v<N, double>;
template <class N>
inline constexpr bool is_index = std::is_integral_v<N> && sizeof(N) == sizeof(std::uint32_t);

template <class R>
concept positions = is_real<number_of<R>> && element<element_of<R>>::count != 2 && element<element_of<R>>::count <= 4;
template <class R>
concept indices = is_index<number_of<R>>;
template <class R>
concept corners = indices<R> &&(element<element_of<R>>::count == 1 || element<element_of<R>>::count == 4);

// Types that own nothing, so that a temporary may be borrowed: ranges such as spans, and an Eigen::Map.
template <class R>
inline constexpr bool owns_nothing = std::ranges::enable_borrowed_range<R>;
template <matrix R>
inline constexpr bool owns_nothing<R> = !std::is_same_v<R, typename R::PlainObject>;

} // namespace detail

// Positions that a call reads: a contiguous range of numbers (x y z x y z ...) or of elements of three or four numbers,
// a matrix of n x 3 or 3 x n (where the compiler knows neither, three columns go before three rows), or vox_positions.
class points : public vox_positions {
public:
    points() : vox_positions() {}
    points(const vox_positions& raw) : vox_positions(raw) {}
    template <detail::positions R>
    points(const R& range) : vox_positions() {
        using number = detail::number_of<R>;
        format = std::is_same_v<number, double> ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
        data = std::data(range);
        const std::uint64_t size = static_cast<std::uint64_t>(std::size(range));
        if constexpr (detail::matrix<R>) {
            if constexpr (!R::IsVectorAtCompileTime) {
                const std::uint64_t rows = static_cast<std::uint64_t>(range.rows()),
                                    columns = static_cast<std::uint64_t>(range.cols());
                const std::uint64_t along = sizeof(number) * static_cast<std::uint64_t>(range.rowStride()),
                                    across = sizeof(number) * static_cast<std::uint64_t>(range.colStride());
                const bool in_rows = int(R::ColsAtCompileTime) == 3 || (int(R::RowsAtCompileTime) != 3 && columns == 3);
                if (!in_rows && rows != 3)
                    detail::refuse("positions: a matrix of %llu x %llu has neither three rows nor three columns", rows,
                                   columns);
                count = in_rows ? rows : columns;
                byte_stride = in_rows ? along : across;
                component_byte_stride = in_rows ? across : along;
                return;
            } else if (range.innerStride() != 1) {
                detail::refuse("positions: a vector whose numbers are %llu apart",
                               static_cast<std::uint64_t>(range.innerStride()));
            }
        }
        using E = element<detail::element_of<R>>;
        if constexpr (E::count == 1 || detail::matrix<R>) {
            count = size / 3;
            if (size % 3 != 0) detail::refuse("positions: %llu numbers are not three for each vertex", size);
        } else {
            static_assert(sizeof(detail::element_of<R>) >= 3 * sizeof(number));
            count = size;
            byte_stride = sizeof(detail::element_of<R>);
        }
    }
};

// Positions that a grid goes on reading after the call, so temporaries that own them are refused.
class borrowed_points : public points {
public:
    borrowed_points() = default;
    borrowed_points(const vox_positions& raw) : points(raw) {}
    template <detail::positions R>
    borrowed_points(const R& range) : points(range) {}
    template <detail::positions R>
    requires(!detail::owns_nothing<std::remove_cv_t<R>>) borrowed_points(const R&& temporary)
    = delete;
};

// Corners of tetrahedra that a call reads: a contiguous range of 32-bit integers, or of elements of four, or a matrix
// in which the four corners of each tetrahedron lie one after the other.
class tets {
public:
    tets() = default;
    tets(std::initializer_list<std::uint32_t> corners)
        : tets(span<const std::uint32_t>(corners.begin(), corners.size())) {}
    template <detail::corners R>
    tets(const R& range) {
        data = reinterpret_cast<const std::uint32_t*>(std::data(range));
        std::uint64_t size = static_cast<std::uint64_t>(std::size(range));
        if constexpr (detail::matrix<R>) {
            const bool one_each = range.innerStride() == 1 &&
                                  (R::IsVectorAtCompileTime || (range.outerStride() == 4 && range.innerSize() == 4));
            if (!one_each)
                detail::refuse("tets: in a matrix of %llu x %llu the corners of a tet do not lie one after the other",
                               static_cast<std::uint64_t>(range.rows()), static_cast<std::uint64_t>(range.cols()));
        } else {
            size *= element<detail::element_of<R>>::count;
        }
        count = size / 4;
        if (size % 4 != 0) detail::refuse("tets: %llu indices are not four for each tet", size);
    }

    const std::uint32_t* data = nullptr;
    std::uint64_t count = 0;
};

// Tetrahedra that go on being read after the call.
class borrowed_tets : public tets {
public:
    borrowed_tets() = default;
    template <detail::corners R>
    borrowed_tets(const R& range) : tets(range) {}
    template <detail::corners R>
    requires(!detail::owns_nothing<std::remove_cv_t<R>>) borrowed_tets(const R&& temporary)
    = delete;
};

// Vertices of primitives, which go on being read after the call: a contiguous range of 32-bit integers, or of elements
// of several, or a matrix in which the vertices of each primitive lie one after the other.
class borrowed_indices {
public:
    borrowed_indices() = default;
    template <detail::indices R>
    borrowed_indices(const R& range) {
        given = true;
        data = reinterpret_cast<const std::uint32_t*>(std::data(range));
        size = static_cast<std::uint64_t>(std::size(range));
        if constexpr (detail::matrix<R>) {
            if (!R::IsVectorAtCompileTime) each = static_cast<std::uint64_t>(range.innerSize());
            if (range.innerStride() != 1 || (!R::IsVectorAtCompileTime && range.outerStride() != range.innerSize()))
                detail::refuse("indices: in a matrix of %llu x %llu they do not lie one after the other",
                               static_cast<std::uint64_t>(range.rows()), static_cast<std::uint64_t>(range.cols()));
        } else {
            each = element<detail::element_of<R>>::count;
            size *= each;
        }
    }
    template <detail::indices R>
    requires(!detail::owns_nothing<std::remove_cv_t<R>>) borrowed_indices(const R&& temporary)
    = delete;

    bool given = false;
    const std::uint32_t* data = nullptr;
    std::uint64_t size = 0;
    std::uint64_t each = 1; // of a primitive; 1: any number
};

namespace detail {

inline vox_mesh_desc desc_of(const points& positions, const tets& tets) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = positions;
    desc.tets = tets.data;
    desc.tet_count = tets.count;
    return desc;
}

} // namespace detail

// A vox_mesh_desc of arrays, which it borrows; its other fields have their defaults, see vox_default_mesh_desc.
inline vox_mesh_desc describe(const borrowed_points& positions, const borrowed_tets& tets = {}) {
    return detail::desc_of(positions, tets);
}

// ---- rigid shapes -------------------------------------------------------------------------------

// vox_shape_desc of each kind, for grid.insert(); its user_data and filter have their defaults. Arrays are borrowed until
// the grid has copied them. `half_length` and the sizes of a box are half the whole; a capsule's is between the centres of its ends.

namespace detail {

inline vox_shape_desc shape_of(vox_shape_kind kind, double radius = 0, double half_length = 0) {
    vox_shape_desc desc = vox_default_shape_desc();
    desc.kind = kind;
    desc.radius = radius;
    desc.half_length = half_length;
    return desc;
}
inline vox_shape_desc sized_shape_of(vox_shape_kind kind, double x, double y, double z) {
    vox_shape_desc desc = shape_of(kind);
    desc.half_size[0] = x;
    desc.half_size[1] = y;
    desc.half_size[2] = z;
    return desc;
}
inline vox_shape_desc surface_of(vox_shape_kind kind, double radius, const points& positions,
                                 const borrowed_indices& triangles) {
    if ((triangles.each != 1 && triangles.each != 3) || triangles.size % 3 != 0)
        refuse("triangles: %llu indices, %llu in each element, are not three for each triangle", triangles.size,
               triangles.each);
    vox_shape_desc desc = shape_of(kind, radius);
    desc.positions = positions;
    desc.triangles = triangles.data;
    desc.triangle_count = triangles.size / 3;
    return desc;
}

} // namespace detail

inline vox_shape_desc half_space() { return detail::shape_of(VOX_SHAPE_HALF_SPACE); }
inline vox_shape_desc sphere(double radius) { return detail::shape_of(VOX_SHAPE_SPHERE, radius); }
inline vox_shape_desc capsule(double radius, double half_length) {
    return detail::shape_of(VOX_SHAPE_CAPSULE, radius, half_length);
}
inline vox_shape_desc cylinder(double radius, double half_length) {
    return detail::shape_of(VOX_SHAPE_CYLINDER, radius, half_length);
}
inline vox_shape_desc box(double half_x, double half_y, double half_z) {
    return detail::sized_shape_of(VOX_SHAPE_BOX, half_x, half_y, half_z);
}
// Row after row, of `columns` heights each.
inline vox_shape_desc heightfield(span<const double> heights, std::uint32_t columns, double spacing_x,
                                  double spacing_y) {
    const std::uint64_t rows = columns > 0 ? heights.size() / columns : 0;
    if (rows * columns != heights.size() || rows > UINT32_MAX)
        detail::refuse("heightfield: %llu heights in rows of %llu", heights.size(), columns);
    vox_shape_desc desc = detail::shape_of(VOX_SHAPE_HEIGHTFIELD);
    desc.heights = heights.data();
    desc.columns = columns;
    desc.rows = static_cast<std::uint32_t>(rows);
    desc.spacing[0] = spacing_x;
    desc.spacing[1] = spacing_y;
    return desc;
}
void heightfield(const std::vector<double>&& temporary, std::uint32_t, double, double) = delete;
// Triangles are a range of indices, or of elements of three.
inline vox_shape_desc solid(const borrowed_points& positions, const borrowed_indices& triangles) {
    return detail::surface_of(VOX_SHAPE_SOLID, 0, positions, triangles);
}
inline vox_shape_desc sheet(const borrowed_points& positions, const borrowed_indices& triangles, double radius = 0) {
    return detail::surface_of(VOX_SHAPE_SHEET, radius, positions, triangles);
}
// Segments between `count` points, one after the other, as triangles of a sheet: a needle, a thread.
inline std::vector<std::array<std::uint32_t, 3>> polyline(std::uint32_t count) {
    std::vector<std::array<std::uint32_t, 3>> segments;
    for (std::uint32_t i = 1; i < count; ++i) segments.push_back({i - 1, i, i});
    return segments;
}
// distance(points, distances, gradients) as vox_shape_desc.field, on several threads at once. It must not throw, and
// must live until the shape is removed.
template <class F>
requires std::is_nothrow_invocable_v<F&, span<const std::array<double, 3>>, span<double>, span<std::array<double, 3>>>
    vox_shape_desc field(F& distance, double half_x, double half_y, double half_z) {
    vox_shape_desc desc = detail::sized_shape_of(VOX_SHAPE_FIELD, half_x, half_y, half_z);
    desc.field = [](const double* at, std::uint64_t count, double* distances, double* gradients, void* user) {
        using place = std::array<double, 3>;
        const std::size_t size = static_cast<std::size_t>(count);
        (*static_cast<F*>(user))(span<const place>(reinterpret_cast<const place*>(at), size),
                                 span<double>(distances, size),
                                 span<place>(reinterpret_cast<place*>(gradients), size));
    };
    desc.field_user = const_cast<std::remove_cv_t<F>*>(std::addressof(distance));
    return desc;
}

// ---- callables ----------------------------------------------------------------------------------

// vox_log: receives a line. The grid keeps it; what it throws is dropped.
using log_function = std::function<void(vox_log_level level, const char* text)>;

// vox_task: runs the items [begin, end) on a worker.
class task {
public:
    task(vox_task* run, void* context) noexcept : run_(run), context_(context) {}
    void operator()(std::uint64_t begin, std::uint64_t end, std::uint32_t worker) const {
        run_(begin, end, worker, context_);
    }

private:
    vox_task* run_;
    void* context_;
};

// vox_task_system in one call: runs `run` over ranges that cover [0, items), of min_range items or more where possible,
// on any threads, and returns when all have run. What it throws makes the call fail and passes through to its caller.
// The grid keeps it. One that does not wait: vox_grid_desc.tasks.
using parallel_for = std::function<void(std::uint64_t items, std::uint64_t min_range, const task& run)>;

namespace detail {

// The callables of a grid, at a fixed address.
struct callbacks {
    log_function log;
    parallel_for tasks;
    catcher caught;

    static void write(vox_log_level level, const char* text, void* user) {
        catcher dropped;
        dropped.run([&] { static_cast<callbacks*>(user)->log(level, text); });
    }
    static void* enqueue(vox_task* run, std::uint64_t items, std::uint64_t min_range, void* context, void* user) {
        callbacks& self = *static_cast<callbacks*>(user);
        self.caught.run([&] { self.tasks(items, min_range, task(run, context)); });
        return nullptr;
    }
    static void finish(void*, void*) {}
    const vox_log c_log{write, this};
    const vox_task_system c_tasks{enqueue, finish, this};

    callbacks() = default;
    callbacks(const callbacks&) = delete;
};

// A desc with the callables in it, and what keeps them alive.
struct settings {
    vox_grid_desc desc;
    std::unique_ptr<callbacks> kept;
    settings(const vox_grid_desc& given, log_function&& log, parallel_for&& tasks) : desc(given) {
        if (!log && !tasks) return;
        kept = std::make_unique<callbacks>();
        kept->log = std::move(log);
        kept->tasks = std::move(tasks);
        if (kept->log) desc.log = &kept->c_log;
        if (kept->tasks) desc.tasks = &kept->c_tasks;
    }
};

} // namespace detail

// vox_allocator over a memory resource, which must live as long as the allocator is used.
inline vox_allocator allocator_of(std::pmr::memory_resource& memory) noexcept {
    return {[](std::size_t size, std::size_t alignment, void* user) -> void* {
                void* got = nullptr;
                detail::catcher none;
                none.run([&] { got = static_cast<std::pmr::memory_resource*>(user)->allocate(size, alignment); });
                return got;
            },
            [](void* at, std::size_t size, std::size_t alignment, void* user) {
                static_cast<std::pmr::memory_resource*>(user)->deallocate(at, size, alignment);
            },
            &memory};
}

// ---- grid ---------------------------------------------------------------------------------------

namespace detail {

template <class M>
std::array<double, 12> rows_of(const M& matrix) {
    std::array<double, 12> rows;
    for (int i = 0; i < 12; ++i) rows[static_cast<std::size_t>(i)] = static_cast<double>(matrix(i / 4, i % 4));
    return rows;
}

// What ends with a grid.
struct grid_deleter {
    bool owned = true;
    std::unique_ptr<callbacks> kept;
    void operator()(vox_grid* grid) noexcept {
        if (owned) vox_grid_destroy(grid);
    }
};

} // namespace detail

// vox_grid. Move-only; its destructor is vox_grid_destroy. One that was moved from is null: calls fail.
class grid {
public:
    // vox_grid_create; a log or a parallel_for replaces that of the desc.
    grid() : grid(vox_default_grid_desc()) {}
    explicit grid(const vox_grid_desc& desc, log_function log = {}, parallel_for tasks = {})
        : grid(made(detail::settings(desc, std::move(log), std::move(tasks)), vox_grid_create)) {}
    // vox_grid_load
    static grid load(span<const std::byte> bytes, const vox_grid_desc& desc = vox_default_grid_desc(),
                     log_function log = {}, parallel_for tasks = {}) {
        return made(detail::settings(desc, std::move(log), std::move(tasks)),
                    [&](const vox_grid_desc* with, vox_grid** out) {
                        return vox_grid_load(bytes.data(), bytes.size(), with, out);
                    });
    }
    // Takes over a grid made in C, to destroy it; with borrow() it stays its owner's, who keeps it alive.
    static grid adopt(vox_grid* raw) { return grid(raw, true); }
    static grid borrow(vox_grid* raw) { return grid(raw, false); }
    // For calls in C. The grid keeps its owner. What a parallel_for throws in such a call comes out of the next one
    // here; until then it runs nothing.
    vox_grid* get() noexcept { return grid_.get(); }
    const vox_grid* get() const noexcept { return grid_.get(); }

    // vox_grid_clear
    void clear() { detail::check(vox_grid_clear(get())); }
    // vox_grid_reserve
    void reserve(std::uint32_t mesh_count, std::uint64_t contact_count) {
        detail::check(vox_grid_reserve(get(), mesh_count, contact_count));
    }
    // vox_grid_prepare
    void prepare() { detail::check(vox_grid_prepare(get())); }
    // vox_grid_set_cell_size
    void set_cell_size(double size) { detail::check(vox_grid_set_cell_size(get(), size)); }
    // vox_grid_get_info
    vox_grid_info info() const { return detail::filled<vox_grid_info>(vox_grid_get_info, get()); }
    // vox_grid_set_margin
    void set_margin(double margin) { detail::check(vox_grid_set_margin(get(), margin)); }
    // vox_grid_set_worker_count
    void set_worker_count(std::uint32_t count) { detail::check(vox_grid_set_worker_count(get(), count)); }
    // vox_grid_set_flags
    void set_flags(std::uint32_t flags) { detail::check(vox_grid_set_flags(get(), flags)); }

    // -- meshes

    // vox_mesh_insert. The positions are borrowed, the tetrahedra copied; describe() is for all else a mesh can have.
    vox_body insert(const borrowed_points& positions, const tets& tets = {}, std::uint64_t user_data = 0) {
        return insert_with(0, positions, tets, user_data);
    }
    // The same with VOX_MESH_COPY_POSITIONS.
    vox_body insert_copy(const points& positions, const tets& tets = {}, std::uint64_t user_data = 0) {
        return insert_with(VOX_MESH_COPY_POSITIONS, positions, tets, user_data);
    }
    // vox_mesh_insert
    vox_body insert(const vox_mesh_desc& desc) { return detail::filled<vox_body>(vox_mesh_insert, get(), &desc); }
    // vox_shape_insert
    vox_body insert(const vox_shape_desc& desc) { return detail::filled<vox_body>(vox_shape_insert, get(), &desc); }
    // vox_body_remove
    void remove(vox_body mesh) { detail::check(vox_body_remove(get(), mesh)); }
    // vox_body_is_valid
    bool contains(vox_body mesh) const noexcept { return vox_body_is_valid(get(), mesh) == 1; }
    // vox_grid_get_bodies
    std::vector<vox_body> meshes() const { return detail::collect<vox_body>(16, vox_grid_get_bodies, get()); }
    // vox_body_get_info
    vox_body_info info(vox_body mesh) const { return detail::filled<vox_body_info>(vox_body_get_info, get(), mesh); }
    // vox_body_get_user_data
    std::uint64_t user_data(vox_body mesh) const {
        return detail::filled<std::uint64_t>(vox_body_get_user_data, get(), mesh);
    }
    // vox_mesh_get_tets: corners, and whether each is enabled.
    std::vector<std::array<std::uint32_t, 4>> tets_of(vox_body mesh) const {
        using corners = std::array<std::uint32_t, 4>;
        return detail::collect<corners>(0, [&](corners* out, std::uint64_t room, std::uint64_t* count) {
            return vox_mesh_get_tets(get(), mesh, reinterpret_cast<std::uint32_t*>(out), nullptr, room, count);
        });
    }
    std::vector<std::uint8_t> tets_enabled(vox_body mesh) const {
        return detail::collect<std::uint8_t>(0, vox_mesh_get_tets, get(), mesh, nullptr);
    }
    // vox_mesh_bind_positions
    void bind(vox_body mesh, const borrowed_points& positions) {
        detail::check(vox_mesh_bind_positions(get(), mesh, &positions));
    }
    // vox_mesh_bind_previous_positions
    void bind_previous(vox_body mesh, const borrowed_points& positions) {
        detail::check(vox_mesh_bind_previous_positions(get(), mesh, &positions));
    }
    // The mesh stands still from now on.
    void end_previous(vox_body mesh) { detail::check(vox_mesh_bind_previous_positions(get(), mesh, nullptr)); }
    // vox_mesh_map_positions: float or double, as the mesh has them. The span ends with them.
    template <class T>
    span<std::array<T, 3>> map_positions(vox_body mesh) & {
        const vox_positions of = positions_of<T>(mesh);
        void* at = nullptr;
        detail::check(vox_mesh_map_positions(get(), mesh, &at));
        return {static_cast<std::array<T, 3>*>(at), static_cast<std::size_t>(of.count)};
    }
    template <class T>
    void map_positions(vox_body mesh) && = delete;
    // vox_body_info.positions, to read; UNSUPPORTED unless they are packed.
    template <class T>
    span<const std::array<T, 3>> positions(vox_body mesh) const& {
        const vox_positions of = positions_of<T>(mesh);
        if (of.data && (of.component_byte_stride != sizeof(T) || of.byte_stride != 3 * sizeof(T)))
            detail::refuse(VOX_ERROR_UNSUPPORTED, "positions of mesh %llu are %llu bytes apart, their numbers %llu",
                           mesh, of.byte_stride, of.component_byte_stride);
        return {static_cast<const std::array<T, 3>*>(of.data), of.data ? static_cast<std::size_t>(of.count) : 0};
    }
    template <class T>
    void positions(vox_body mesh) const&& = delete;
    // vox_body_mark_moved
    void mark_moved(vox_body mesh) { detail::check(vox_body_mark_moved(get(), mesh)); }
    // vox_body_set_filter
    void set_filter(vox_body mesh, const vox_filter& filter) {
        detail::check(vox_body_set_filter(get(), mesh, &filter));
    }
    // vox_body_set_enabled
    void set_enabled(vox_body mesh, bool enabled) { detail::check(vox_body_set_enabled(get(), mesh, enabled)); }
    // vox_grid_set_pair_enabled
    void set_pair_enabled(vox_body a, vox_body b, bool enabled) {
        detail::check(vox_grid_set_pair_enabled(get(), a, b, enabled));
    }
    // vox_body_set_transform: twelve numbers row by row, or a matrix of at least 3 x 4 that is read as m(row, column).
    void set_transform(vox_body body, const double (&rows)[12]) {
        detail::check(vox_body_set_transform(get(), body, rows));
    }
    void set_transform(vox_body body, const std::array<double, 12>& rows) {
        detail::check(vox_body_set_transform(get(), body, rows.data()));
    }
    template <class M, class = decltype(static_cast<double>(std::declval<const M&>()(0, 0)))>
    void set_transform(vox_body body, const M& matrix) {
        return set_transform(body, detail::rows_of(matrix));
    }
    void clear_transform(vox_body body) { detail::check(vox_body_set_transform(get(), body, nullptr)); }
    // vox_shape_set_previous_transform, likewise.
    void set_previous_transform(vox_body shape, const double (&rows)[12]) {
        detail::check(vox_shape_set_previous_transform(get(), shape, rows));
    }
    void set_previous_transform(vox_body shape, const std::array<double, 12>& rows) {
        detail::check(vox_shape_set_previous_transform(get(), shape, rows.data()));
    }
    template <class M, class = decltype(static_cast<double>(std::declval<const M&>()(0, 0)))>
    void set_previous_transform(vox_body shape, const M& matrix) {
        return set_previous_transform(shape, detail::rows_of(matrix));
    }
    // The shape stands still from now on.
    void end_previous_transform(vox_body shape) {
        detail::check(vox_shape_set_previous_transform(get(), shape, nullptr));
    }

    // -- cutting and growing

    // vox_mesh_set_topology
    void set_topology(vox_body mesh, const vox_mesh_desc& desc) {
        detail::check(vox_mesh_set_topology(get(), mesh, &desc));
    }
    void set_topology(vox_body mesh, const borrowed_points& positions, const tets& tets) {
        set_topology(mesh, detail::desc_of(positions, tets));
    }
    // vox_mesh_set_tets_enabled
    void set_tets_enabled(vox_body mesh, span<const std::uint32_t> indices, bool enabled) {
        detail::check(vox_mesh_set_tets_enabled(get(), mesh, indices.data(), indices.size(), enabled));
    }
    // vox_mesh_replace_tets
    void replace_tets(vox_body mesh, span<const std::uint32_t> indices, const tets& corners) {
        if (corners.count != indices.size())
            detail::refuse("replace_tets: %llu tets to replace, by %llu", indices.size(), corners.count);
        detail::check(vox_mesh_replace_tets(get(), mesh, indices.data(), indices.size(), corners.data));
    }
    // vox_mesh_append_tets
    std::uint32_t append_tets(vox_body mesh, const tets& corners) {
        std::uint32_t first = 0;
        detail::check(vox_mesh_append_tets(get(), mesh, corners.data, corners.count, &first));
        return first;
    }
    // vox_mesh_remove_tets
    void remove_tets(vox_body mesh, span<const std::uint32_t> indices) {
        detail::check(vox_mesh_remove_tets(get(), mesh, indices.data(), indices.size()));
    }
    // vox_mesh_append_vertices
    std::uint32_t append_vertices(vox_body mesh, const vox_vertices_desc& desc) {
        std::uint32_t first = 0;
        detail::check(vox_mesh_append_vertices(get(), mesh, &desc, &first));
        return first;
    }
    // The same for `count` vertices.
    std::uint32_t append_vertices(vox_body mesh, std::uint64_t count, const borrowed_points& positions,
                                  span<const std::uint32_t> copies_of = {}) {
        if (!copies_of.empty() && copies_of.size() != count)
            detail::refuse("append_vertices: %llu vertices, copies of %llu", count, copies_of.size());
        vox_vertices_desc desc = vox_default_vertices_desc();
        desc.count = count;
        desc.positions = positions;
        desc.copies_of = copies_of.empty() ? nullptr : copies_of.data();
        return append_vertices(mesh, desc);
    }
    // vox_mesh_remove_vertices
    void remove_vertices(vox_body mesh, span<const std::uint32_t> vertices) {
        detail::check(vox_mesh_remove_vertices(get(), mesh, vertices.data(), vertices.size()));
    }

    // -- step and results

    // vox_grid_step
    void step() { return done(vox_grid_step(get())); }
    // vox_grid_get_failure
    vox_failure failure(std::uint32_t index = 0) const {
        return detail::filled<vox_failure>(vox_grid_get_failure, get(), index);
    }
    // vox_grid_get_contacts. This and all below live as long as vox.h says.
    span<const vox_contact> contacts() const& { return all(vox_grid_get_contacts); }
    // vox_contact_view.interiors
    span<const std::uint8_t> interiors() const& {
        const vox_contact_view view = read(vox_grid_get_contacts);
        return {view.interiors, static_cast<std::size_t>(view.count)};
    }
    // vox_grid_get_pairs
    span<const vox_pair> pairs() const& { return all(vox_grid_get_pairs); }
    // vox_pair_view.contacts: indices in contacts() of those of a pair of the last step.
    span<const std::uint32_t> contacts_of(const vox_pair& pair) const& {
        return {read(vox_grid_get_pairs).contacts + pair.first_contact, static_cast<std::size_t>(pair.contact_count)};
    }
    // vox_grid_find_constraints
    void find_constraints(const vox_constraint_desc& desc = vox_default_constraint_desc()) {
        return done(vox_grid_find_constraints(get(), &desc));
    }
    // vox_grid_get_constraints
    span<const vox_constraint> constraints() const& { return all(vox_grid_get_constraints); }
    // vox_constraint_view.pair_offsets: those of a pair of the last step.
    span<const vox_constraint> constraints_of(const vox_pair& pair) const& {
        const vox_constraint_view found = read(vox_grid_get_constraints);
        const span<const vox_pair> sorted = pairs();
        const auto before = [](const vox_pair& a, const vox_pair& b) {
            return a.body_a != b.body_a ? a.body_a < b.body_a : a.body_b < b.body_b;
        };
        const auto at = std::lower_bound(sorted.begin(), sorted.end(), pair, before);
        if (at == sorted.end() || before(pair, *at)) return {};
        const std::uint64_t* offsets = found.pair_offsets + (at - sorted.begin());
        return {found.data + offsets[0], static_cast<std::size_t>(offsets[1] - offsets[0])};
    }
    // A temporary grid has no results to look at.
    void contacts() const&& = delete;
    void interiors() const&& = delete;
    void pairs() const&& = delete;
    void contacts_of(const vox_pair&) const&& = delete;
    void constraints() const&& = delete;
    void constraints_of(const vox_pair&) const&& = delete;

    // vox_grid_get_hash
    std::uint64_t hash() const { return detail::filled<std::uint64_t>(vox_grid_get_hash, get()); }
    // vox_grid_save
    std::vector<std::byte> save() const {
        std::uint64_t size = 0;
        detail::check(vox_grid_save(get(), nullptr, 0, &size));
        std::vector<std::byte> bytes(static_cast<std::size_t>(size));
        detail::check(vox_grid_save(get(), bytes.data(), bytes.size(), &size));
        return bytes;
    }
    // vox_grid_get_counters
    span<const vox_counter> counters() const& { return all(vox_grid_get_counters); }
    void counters() const&& = delete;

private:
    friend class locator; // vox_query.hpp
    friend void step(span<grid> grids, std::uint32_t worker_count, span<vox_result> results, parallel_for tasks);

    grid(vox_grid* raw, bool owned, std::unique_ptr<detail::callbacks> kept = nullptr)
        : grid_(raw, detail::grid_deleter{owned, std::move(kept)}) {}

    template <class F>
    static grid made(detail::settings&& with, F&& call) {
        grid made(nullptr, true, std::move(with.kept));
        vox_grid* raw = nullptr;
        const vox_result result = call(&with.desc, &raw);
        made.grid_.reset(raw);
        detail::check(result);
        return made;
    }
    template <class V>
    V read(vox_result (*results)(const vox_grid*, V*)) const {
        return detail::filled<V>(results, get());
    }
    template <class V>
    span<std::remove_pointer_t<decltype(V::data)>> all(vox_result (*results)(const vox_grid*, V*)) const {
        const V view = read(results);
        return {view.data, static_cast<std::size_t>(view.count)};
    }
    // After calls that run the task system.
    void rethrow() {
        if (const auto& kept = grid_.get_deleter().kept) kept->caught.rethrow();
    }
    void done(vox_result result) {
        rethrow();
        detail::check(result);
    }
    template <class T>
    vox_positions positions_of(vox_body mesh) const {
        static_assert(std::is_same_v<T, float> || std::is_same_v<T, double>);
        const vox_positions of = info(mesh).positions;
        if (of.format != (std::is_same_v<T, double> ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT))
            detail::refuse("positions of mesh %llu are of format %llu, not numbers of %llu bytes", mesh, of.format,
                           sizeof(T));
        return of;
    }
    vox_body insert_with(std::uint32_t flags, const points& positions, const tets& tets, std::uint64_t user_data) {
        vox_mesh_desc desc = detail::desc_of(positions, tets);
        desc.flags = flags;
        desc.user_data = user_data;
        return insert(desc);
    }

    std::unique_ptr<vox_grid, detail::grid_deleter> grid_;
};

// A mesh that its owner removes (vox_body_remove), e.g. before the positions that it borrows. The grid must outlive it.
class unique_mesh {
public:
    unique_mesh() noexcept = default;
    unique_mesh(grid& grid, vox_body mesh) : grid_(grid.get()), mesh_(mesh) {}
    unique_mesh(grid&& grid, vox_body mesh) = delete;
    unique_mesh(unique_mesh&& other) noexcept : grid_(other.grid_), mesh_(other.release()) {}
    unique_mesh& operator=(unique_mesh&& other) noexcept {
        if (this == &other) return *this;
        reset();
        grid_ = other.grid_;
        mesh_ = other.release();
        return *this;
    }
    ~unique_mesh() { reset(); }
    vox_body get() const noexcept { return mesh_; }
    vox_body release() noexcept { return std::exchange(mesh_, vox_body{VOX_NULL_BODY}); } // stays in the grid
    void reset() noexcept {
        const vox_body mesh = release();
        if (mesh != VOX_NULL_BODY) (void)vox_body_remove(grid_, mesh); // may be gone already
    }

private:
    vox_grid* grid_ = nullptr;
    vox_body mesh_ = VOX_NULL_BODY;
};

// ---- many grids ---------------------------------------------------------------------------------

// vox_grids_step. `results` is empty or has room for one a grid.
inline void step(span<grid> grids, std::uint32_t worker_count = VOX_ALL_CORES, span<vox_result> results = {},
                 parallel_for tasks = {}) {
    std::vector<vox_grid*> raw;
    raw.reserve(grids.size());
    for (grid& one : grids) raw.push_back(one.get());
    if (!results.empty() && results.size() < raw.size())
        detail::refuse("step: room for %llu results, of %llu grids", results.size(), raw.size());
    detail::callbacks own;
    own.tasks = std::move(tasks);
    const vox_result result = vox_grids_step(raw.data(), raw.size(), worker_count, own.tasks ? &own.c_tasks : nullptr,
                                             results.empty() ? nullptr : results.data());
    for (grid& one : grids)
        if (const auto& kept = one.grid_.get_deleter().kept) own.caught.take(kept->caught);
    own.caught.rethrow();
    detail::check(result);
}

// ---- constraints --------------------------------------------------------------------------------

// vox_constraint_gap, of packed positions, three numbers each.
inline double constraint_gap(const vox_constraint& c, span<const double> positions_a,
                             span<const double> positions_b) noexcept {
    return vox_constraint_gap(&c, positions_a.data(), positions_b.data());
}

// ---- version ------------------------------------------------------------------------------------

inline std::uint32_t version() noexcept { return vox_version(); }         // vox_version
inline std::uint32_t abi_version() noexcept { return vox_abi_version(); } // vox_abi_version
inline const char* build_info() noexcept { return vox_build_info(); }     // vox_build_info

// ---- Eigen --------------------------------------------------------------------------------------

#if defined(EIGEN_WORLD_VERSION)
namespace detail {
template <class E, class N>
auto eigen_map(N* first, std::size_t count, std::size_t byte_stride) {
    constexpr int rows = static_cast<int>(E::count);
    using matrix = Eigen::Matrix<std::remove_const_t<N>, rows, Eigen::Dynamic>;
    using mapped = std::conditional_t<std::is_const_v<N>, const matrix, matrix>;
    using stride = std::conditional_t<rows == 1, Eigen::InnerStride<>, Eigen::OuterStride<>>;
    return Eigen::Map<mapped, Eigen::Unaligned, stride>(first, rows, static_cast<Eigen::Index>(count),
                                                        stride(static_cast<Eigen::Index>(byte_stride / sizeof(N))));
}
} // namespace detail

// The memory of an array, or of one field of its elements, as a matrix of a column an element:
// eigen_map(grid.constraints(), &vox_constraint::normal).
template <class A>
auto eigen_map(span<A> elements) {
    using E = element<std::remove_const_t<A>>;
    using N = std::conditional_t<std::is_const_v<A>, const typename E::number, typename E::number>;
    return detail::eigen_map<E>(reinterpret_cast<N*>(elements.data()), elements.size(), sizeof(A));
}
template <class S, class M>
auto eigen_map(span<const S> elements, M S::*field) {
    using E = element<M>;
    const void* first = elements.empty() ? nullptr : &(elements.front().*field);
    return detail::eigen_map<E>(static_cast<const typename E::number*>(first), elements.size(), sizeof(S));
}
#endif

} // namespace vox

#endif
