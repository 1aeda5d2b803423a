// Snapshots as bytes: a header, then chunks, all little-endian (docs/snapshot.md). What the chunks hold is
// defined in snapshot.cpp and snapshot_meshes.cpp.
//   chunk names: an upper-case first letter means that a reader which does not know the chunk must refuse the
//   file, a lower-case one that it may skip it; the rule of PNG (ISO/IEC 15948:2004, 5.4)
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace vox {

// CRC-32 of ISO/IEC 3309 (polynomial 0x04c11db7, reflected), as in PNG and zlib.
std::uint32_t crc32(std::span<const std::byte> bytes) noexcept;

// Writes a snapshot into memory that is large enough, or only counts its bytes.
class SnapshotWriter {
public:
    explicit SnapshotWriter(std::byte* out); // null: counts

    void begin_chunk(const char* name);
    void u32(std::uint32_t value) noexcept {
        if (out_)
            for (unsigned i = 0; i < 4; ++i) out_[size_ + i] = static_cast<std::byte>(value >> 8 * i);
        size_ += 4;
    }
    void u64(std::uint64_t value) noexcept {
        u32(static_cast<std::uint32_t>(value));
        u32(static_cast<std::uint32_t>(value >> 32));
    }
    void real(float value) noexcept { u32(std::bit_cast<std::uint32_t>(value)); }
    void real(double value) noexcept { u64(std::bit_cast<std::uint64_t>(value)); }
    template <class Point>
    void point(const Point& p) noexcept {
        for (const auto x : {p.x, p.y, p.z}) real(x);
    }
    void end_chunk() noexcept;

    // After the last chunk: fills in the header; returns the number of bytes.
    std::uint64_t finish() noexcept;

private:
    void u64_at(std::uint64_t at, std::uint64_t value) noexcept;

    std::byte* out_;
    std::uint64_t size_ = 0;
    std::uint64_t chunk_ = 0; // where the payload of the open chunk begins
};

// One chunk's payload, read field by field. Whatever does not fit throws Error(FORMAT) with chunk and byte.
class SnapshotChunk {
public:
    SnapshotChunk() = default;
    SnapshotChunk(const std::array<char, 4>& name, std::span<const std::byte> payload, std::uint64_t at)
        : name_(name), payload_(payload), at_(at) {}

    bool is(const char* name) const noexcept { return std::string(name_.data(), 4) == name; }
    bool may_be_skipped() const noexcept { return name_[0] >= 'a' && name_[0] <= 'z'; }
    std::string name() const; // printable

    std::size_t left() const noexcept { return payload_.size() - next_; }
    std::uint32_t u32();
    std::uint64_t u64();
    template <class Real>
    Real real() {
        if constexpr (sizeof(Real) == 4)
            return std::bit_cast<Real>(u32());
        else
            return std::bit_cast<Real>(u64());
    }
    // A u32 that is 0 or 1; `what` names it.
    bool flag(const char* what);
    void reserved_word(); // a u32 that is 0
    // Throws unless `count` elements of so many bytes are left: call it before memory is taken for them.
    void expect(std::uint64_t count, std::uint64_t element_bytes, const char* what) const;
    // Throws unless all has been read.
    void end() const;

    // Error(FORMAT) about this chunk.
    [[noreturn]] void refuse(const std::string& text) const;

private:
    const std::byte* number(std::size_t bytes); // the next one

    std::array<char, 4> name_{};
    std::span<const std::byte> payload_;
    std::uint64_t at_ = 0; // of the chunk in the snapshot
    std::size_t next_ = 0; // in payload_
};

// The chunks of a snapshot, in order.
class SnapshotReader {
public:
    // Checks header, size and checksum. Throws Error(FORMAT), or UNSUPPORTED for a later version.
    explicit SnapshotReader(std::span<const std::byte> bytes);

    // The next chunk; false at the end.
    bool next(SnapshotChunk& out);

private:
    std::span<const std::byte> bytes_;
    std::size_t next_;
};

} // namespace vox
