// What ranks send each other: plain structs, one after the other, in the byte order of the machine.
#pragma once

#include "base/array.hpp"
#include "base/error.hpp"

#include <vox/vox_dist.h>

#include <cstddef>
#include <cstring>
#include <limits>
#include <memory_resource>
#include <type_traits>

namespace vox::dist {

// Closed; empty if a minimum is above its maximum.
struct Box {
    static constexpr float far = std::numeric_limits<float>::infinity();
    float min[3] = {far, far, far};
    float max[3] = {-far, -far, -far};

    bool empty() const noexcept { return !(min[0] <= max[0]); }
    void add(const Box& other) noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            if (other.min[axis] < min[axis]) min[axis] = other.min[axis];
            if (other.max[axis] > max[axis]) max[axis] = other.max[axis];
        }
    }
    bool meets(const Box& other) const noexcept {
        for (int axis = 0; axis < 3; ++axis)
            if (!(min[axis] <= other.max[axis] && other.min[axis] <= max[axis])) return false;
        return true;
    }
    bool holds(const double point[3]) const noexcept {
        for (int axis = 0; axis < 3; ++axis)
            if (!(min[axis] <= point[axis] && point[axis] <= max[axis])) return false;
        return true;
    }
};

// What the ranks are in.
enum class Call : std::uint16_t { step, locate, check };

// What every rank knows of every rank: 64 bytes.
struct Overview {
    Box tets;     // of the tetrahedra there
    Box vertices; // of the vertices owned there, or the points asked for
    std::int32_t result = VOX_OK;
    Call call = Call::step;
    std::uint16_t one_body = 0; // 1: all vertices are of `body`, which does not collide with itself
    std::uint64_t body = 0;

    // Whether vertices there can be in tetrahedra of `of`, as far as bodies decide.
    bool collides_with(std::uint64_t of) const noexcept { return one_body == 0 || body != of; }
    // The same for the tetrahedra of all parts of a rank.
    bool collides_with(const Overview& tets_of) const noexcept {
        return tets_of.one_body == 0 || collides_with(tets_of.body);
    }
};
static_assert(sizeof(Overview) == 64);

// Which bodies collide: as vox_filter says.
struct Filter {
    std::uint64_t category = 1, mask = UINT64_MAX;
    std::int32_t group = 0;
    std::uint32_t world = 0, self_collision = 0, reserved = 0; // sent as they lie
    friend bool operator==(const Filter&, const Filter&) = default;
};

// Of a part, before its filter, a box around its boxes, and these, packed. One box is the box around it, and
// is not sent again.
struct PartBoxes {
    std::uint64_t body;
    std::uint32_t part;  // a number of the sender's, which hits come back with
    std::uint32_t boxes; // the highest bit: a filter follows
};
constexpr std::uint32_t filter_bit = 0x80000000u;

// A vertex, with its position as it is: in 32 bytes, or in 20.
struct VertexDoubles {
    std::uint64_t id;
    double position[3];
};
#pragma pack(push, 4)
struct VertexFloats {
    std::uint64_t id;
    float position[3];
};
#pragma pack(pop)
static_assert(sizeof(VertexDoubles) == 32 && sizeof(VertexFloats) == 20);

// Vertices of a body, before its filter and them. Points that are asked for have no body.
struct Vertices {
    std::uint64_t body;
    std::uint32_t count;
    std::uint16_t doubles;    // 1 or 0
    std::uint16_t has_filter; // 1; or 0: it has the default one
};

// Hits of one rank for another, before them.
struct Hits {
    std::uint64_t count;
    std::uint64_t undecided; // on a boundary, of a body that other ranks have tetrahedra of
};

// A vertex that was sent, in a tetrahedron.
struct Hit {
    std::uint64_t tet;
    std::uint32_t vertex; // its place among those that were sent to the rank
    std::uint32_t part;   // as in PartBoxes; the highest bit: the vertex is in the interior
    double weights[4];
};
static_assert(sizeof(Hit) == 48);
constexpr std::uint32_t interior_bit = 0x80000000u;

using Memory = std::pmr::memory_resource;

class Writer {
public:
    explicit Writer(Memory* memory) : bytes_(memory) {}
    void clear() noexcept { bytes_.clear(); }
    template <class T>
    std::size_t add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof value);
        std::memcpy(bytes_.data() + at, &value, sizeof value);
        return at;
    }
    void add(const void* data, std::size_t size) {
        const auto* from = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), from, from + size);
    }
    template <class T>
    void set(std::size_t at, const T& value) noexcept {
        std::memcpy(bytes_.data() + at, &value, sizeof value);
    }
    std::size_t size() const noexcept { return bytes_.size(); }
    void shrink(std::size_t size) { bytes_.resize(size); }
    vox_dist_message bytes() const noexcept { return {bytes_.data(), bytes_.size()}; }

private:
    Array<std::byte> bytes_;
};

class Reader {
public:
    explicit Reader(const vox_dist_message& bytes) noexcept
        : at_(static_cast<const std::byte*>(bytes.data)), left_(bytes.size) {}
    bool more() const noexcept { return left_ != 0; }
    template <class T>
    T take() {
        if (left_ < sizeof(T)) throw Error(VOX_ERROR_INTERNAL, "a message of another rank is too short");
        T value;
        std::memcpy(&value, at_, sizeof value);
        at_ += sizeof value;
        left_ -= sizeof value;
        return value;
    }
    // False if there are fewer bytes.
    bool take(void* out, std::uint64_t size) noexcept {
        if (left_ < size) return false;
        std::memcpy(out, at_, size);
        at_ += size;
        left_ -= size;
        return true;
    }

private:
    const std::byte* at_;
    std::uint64_t left_;
};

} // namespace vox::dist
