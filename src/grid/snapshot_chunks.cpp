#include "grid/snapshot_chunks.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cinttypes>

namespace vox {

namespace {

// A byte above 127 and both line ends, so that a transfer as text is noticed: as in PNG.
constexpr std::array<unsigned char, 8> magic = {0x89, 'V', 'O', 'X', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t version = 1;
// magic, version, CRC of all that follows, size of the whole
constexpr std::size_t crc_at = 12, checked_from = 16, size_at = 16, header_bytes = 24;
constexpr std::size_t chunk_header_bytes = 16; // name, 0, size of the payload

constexpr std::uint64_t padded(std::uint64_t bytes) { return (bytes + 7) / 8 * 8; }

constexpr auto crc_table = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t remainder = byte;
        for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) ? 0xedb88320u : 0u);
        table[byte] = remainder;
    }
    return table;
}();

std::uint32_t u32_of(const std::byte* bytes) noexcept {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[i]) << 8 * i;
    return value;
}

std::uint64_t u64_of(const std::byte* bytes) noexcept {
    return u32_of(bytes) | std::uint64_t{u32_of(bytes + 4)} << 32;
}

} // namespace

std::uint32_t crc32(std::span<const std::byte> bytes) noexcept {
    std::uint32_t remainder = 0xffffffffu;
    for (const std::byte byte : bytes)
        remainder = (remainder >> 8) ^ crc_table[(remainder ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
    return ~remainder;
}

// ---- writing --------------------------------------------------------------------------------------

SnapshotWriter::SnapshotWriter(std::byte* out) : out_(out) {
    if (out_)
        for (std::size_t i = 0; i < magic.size(); ++i) out_[i] = static_cast<std::byte>(magic[i]);
    size_ = magic.size();
    u32(version);
    u32(0); // the checksum and the size, when all is there
    u64(0);
}

void SnapshotWriter::begin_chunk(const char* name) {
    if (out_)
        for (std::size_t i = 0; i < 4; ++i) out_[size_ + i] = static_cast<std::byte>(name[i]);
    size_ += 4;
    u32(0);
    u64(0); // the size
    chunk_ = size_;
}

void SnapshotWriter::end_chunk() noexcept {
    u64_at(chunk_ - 8, size_ - chunk_);
    const std::uint64_t end = padded(size_);
    if (out_) std::fill(out_ + size_, out_ + end, std::byte{0});
    size_ = end;
}

void SnapshotWriter::u64_at(std::uint64_t at, std::uint64_t value) noexcept {
    const std::uint64_t end = size_;
    size_ = at;
    u64(value);
    size_ = end;
}

std::uint64_t SnapshotWriter::finish() noexcept {
    u64_at(size_at, size_);
    if (out_) {
        const std::uint64_t end = size_;
        size_ = crc_at;
        u32(crc32({out_ + checked_from, out_ + end}));
        size_ = end;
    }
    return size_;
}

// ---- reading --------------------------------------------------------------------------------------

SnapshotReader::SnapshotReader(std::span<const std::byte> bytes) : bytes_(bytes), next_(header_bytes) {
    const auto refuse = [](vox_result result, const std::string& text) {
        throw Error(result, "snapshot: " + text);
    };
    if (bytes.size() < header_bytes)
        refuse(VOX_ERROR_FORMAT, format("%zu bytes, the header alone has %zu", bytes.size(), header_bytes));
    for (std::size_t i = 0; i < magic.size(); ++i)
        if (bytes[i] != static_cast<std::byte>(magic[i]))
            refuse(VOX_ERROR_FORMAT, format("byte %zu is 0x%02x, expected 0x%02x: not a snapshot", i,
                                            std::to_integer<unsigned>(bytes[i]), unsigned{magic[i]}));
    const std::uint32_t found_version = u32_of(&bytes[magic.size()]);
    if (found_version == 0) refuse(VOX_ERROR_FORMAT, "version 0");
    if (found_version > version)
        refuse(VOX_ERROR_UNSUPPORTED,
               format("version %" PRIu32 ", this library reads up to %" PRIu32, found_version, version));
    const std::uint64_t size = u64_of(&bytes[size_at]);
    if (size != bytes.size())
        refuse(VOX_ERROR_FORMAT, format("%zu bytes, the header says %" PRIu64 "%s", bytes.size(), size,
                                        bytes.size() < size ? ": it is cut off" : ""));
    const std::uint32_t expected = u32_of(&bytes[crc_at]), found = crc32(bytes.subspan(checked_from));
    if (found != expected)
        refuse(VOX_ERROR_FORMAT,
               format("checksum is %08" PRIx32 ", the header says %08" PRIx32 ": it is damaged", found,
                      expected));
}

bool SnapshotReader::next(SnapshotChunk& out) {
    const std::size_t left = bytes_.size() - next_;
    if (left == 0) return false;
    if (left < chunk_header_bytes)
        throw Error(VOX_ERROR_FORMAT, format("snapshot: %zu bytes at byte %zu, a chunk begins with %zu", left,
                                             next_, chunk_header_bytes));
    const std::byte* header = &bytes_[next_];
    std::array<char, 4> name;
    for (std::size_t i = 0; i < 4; ++i) name[i] = std::to_integer<char>(header[i]);
    const std::uint64_t size = u64_of(header + 8), room = left - chunk_header_bytes;
    const SnapshotChunk whole(name, {}, next_);
    if (u32_of(header + 4) != 0)
        whole.refuse(format("its second word is %" PRIu32 ", expected 0", u32_of(header + 4)));
    if (size > room || padded(size) > room)
        whole.refuse(format("it has %" PRIu64 " bytes, the snapshot only %" PRIu64 " more", size, room));
    out = SnapshotChunk(name, bytes_.subspan(next_ + chunk_header_bytes, static_cast<std::size_t>(size)),
                        next_);
    next_ += chunk_header_bytes + static_cast<std::size_t>(padded(size));
    return true;
}

std::string SnapshotChunk::name() const {
    std::string text;
    for (const char c : name_) text += c >= ' ' && c <= '~' ? c : '?';
    return text;
}

void SnapshotChunk::refuse(const std::string& text) const {
    throw Error(VOX_ERROR_FORMAT,
                format("snapshot: chunk %s at byte %" PRIu64 ": %s", name().c_str(), at_, text.c_str()));
}

void SnapshotChunk::expect(std::uint64_t count, std::uint64_t element_bytes, const char* what) const {
    const std::uint64_t left = payload_.size() - next_;
    if (count > left / element_bytes)
        refuse(format("%" PRIu64 " %s of %" PRIu64 " bytes each, it has %" PRIu64 " more bytes", count, what,
                      element_bytes, left));
}

const std::byte* SnapshotChunk::number(std::size_t bytes) {
    expect(1, bytes, "number");
    next_ += bytes;
    return &payload_[next_ - bytes];
}

std::uint32_t SnapshotChunk::u32() { return u32_of(number(4)); }

std::uint64_t SnapshotChunk::u64() { return u64_of(number(8)); }

bool SnapshotChunk::flag(const char* what) {
    const std::uint32_t value = u32();
    if (value > 1) refuse(format("%s is %" PRIu32 ", expected 0 or 1", what, value));
    return value == 1;
}

void SnapshotChunk::reserved_word() {
    if (const std::uint32_t value = u32(); value != 0)
        refuse(format("a reserved word is %" PRIu32 ", expected 0", value));
}

void SnapshotChunk::end() const {
    if (next_ != payload_.size()) refuse(format("%zu bytes, expected %zu", payload_.size(), next_));
}

} // namespace vox
