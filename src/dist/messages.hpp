// What ranks send each other: plain structs, one after the other, in the byte order of the machine.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/error.hpp"

#include <vox/vox_dist.h>

#include <cstddef>
#include <cstring>
#include <memory_resource>
#include <type_traits>

namespace vox::dist {

// The collective function that the ranks are in.
enum class Call : std::uint16_t { step, locate, check };

// What every rank knows of every rank: 64 bytes.
struct Overview {
    Box3f tets = empty_box3f();     // around its tetrahedra
    Box3f vertices = empty_box3f(); // around the vertices that it owns, or the points that it asks about
    std::int32_t result = VOX_OK;
    Call call = Call::step;
    std::uint16_t one_body = 0; // 1: it has `body` alone, which does not collide with itself
    std::uint64_t body = 0;

    // Whether its vertices can be in tetrahedra of `other`, judging by body numbers alone.
    bool collides_with(std::uint64_t other) const noexcept { return one_body == 0 || body != other; }
    bool collides_with(const Overview& other) const noexcept {
        return other.one_body == 0 || collides_with(other.body);
    }
};
static_assert(sizeof(Overview) == 64);

// Which bodies collide (vox_filter), in the bytes of a message.
struct Filter : PairFilter {
    std::uint32_t self_collision = 0, reserved = 0;
    bool operator==(const Filter&) const = default;
};
static_assert(sizeof(Filter) == 32);

inline bool collide(std::uint64_t body_a, const Filter& a, std::uint64_t body_b, const Filter& b) noexcept {
    return body_a == body_b ? a.self_collision != 0 : vox::collide(a, b);
}

// Precedes the filter of a part, if it has one, a frame around its boxes, and these, packed. A single box is
// its own frame, and is not sent again.
struct PartBoxes {
    std::uint64_t body;
    std::uint32_t part;  // the sender's number, which hits name
    std::uint32_t boxes; // with filter_bit: a filter follows
};
constexpr std::uint32_t filter_bit = 0x80000000u;

// A vertex in 32 bytes, or in 20 where floats hold its position.
struct VertexDoubles {
    std::uint64_t id;
    Vec3d position;
};
#pragma pack(push, 4)
struct VertexFloats {
    std::uint64_t id;
    Vec3f position;
};
#pragma pack(pop)
static_assert(sizeof(VertexDoubles) == 32 && sizeof(VertexFloats) == 20);

// Precedes the filter of a body, if it has one, and its vertices. Points that are asked about have no body.
struct VerticesHeader {
    std::uint64_t body;
    std::uint32_t count;
    std::uint16_t doubles;    // 1 or 0
    std::uint16_t has_filter; // 1, or 0 for the default filter
};

// Precedes the hits of one rank for another.
struct HitsHeader {
    std::uint64_t count;
    std::uint64_t undecided; // on a boundary, in a body with tetrahedra on several ranks
};

// A received vertex in a tetrahedron.
struct SentHit {
    std::uint64_t tet;
    std::uint32_t vertex; // its place among those that the rank was sent
    std::uint32_t part;   // PartBoxes::part; with interior_bit: the vertex is in the interior
    double weights[4];
};
static_assert(sizeof(SentHit) == 48);
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
        T value;
        if (!take(&value, sizeof value))
            throw Error(VOX_ERROR_INTERNAL, "a message of another rank is too short");
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
