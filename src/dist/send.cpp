// Sends an item for each contact from one side to the other. Two ranks have their common contacts in the same
// order, so that no numbers need to be sent.
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "dist/scene.hpp"

#include <algorithm>

using namespace vox;
using namespace vox::dist;

namespace {

struct ItemsHeader {
    std::uint64_t bytes; // an item
    std::uint64_t from;  // a vox_dist_side
};

const char* name_of(std::uint64_t side) noexcept { return side == VOX_DIST_VERTICES ? "vertices" : "tets"; }

} // namespace

void vox_dist_scene::send(std::int32_t from, std::uint64_t item_bytes, const void* in, void* out) {
    Failure failure;
    const bool from_vertices = from == VOX_DIST_VERTICES;
    const std::uint64_t side = from_vertices ? VOX_DIST_VERTICES : VOX_DIST_TETS;
    const Array<vox_dist_contact>& senders = from_vertices ? contacts_ : tet_contacts_;
    const Array<vox_dist_contact>& receivers = from_vertices ? tet_contacts_ : contacts_;

    // The ranks to exchange items with. Both sides find the same, and need no memory, so this cannot fail.
    const std::uint32_t me = transport_.rank();
    std::fill(has_contacts_.begin(), has_contacts_.end(), std::uint8_t{0});
    for (const vox_dist_contact& contact : contacts_) has_contacts_[contact.rank] = 1;
    for (const vox_dist_contact& contact : tet_contacts_) has_contacts_[contact.rank] = 1;
    rank_count_ = 0;
    for (std::uint32_t rank = 0; rank < transport_.size(); ++rank)
        if (rank != me && has_contacts_[rank]) ranks_[rank_count_++] = rank;

    Array<Writer> writers(&memory_);
    Array<const std::byte*> here(&memory_); // items for this rank itself
    const auto* items = static_cast<const std::byte*>(in);
    const auto place_of = [&](std::uint32_t rank) {
        return static_cast<std::size_t>(std::lower_bound(ranks_.begin(), ranks_.begin() + rank_count_, rank) -
                                        ranks_.begin());
    };
    failure.guard([&] {
        check_enum(from, VOX_DIST_TETS, "from");
        if (item_bytes == 0 || item_bytes > 65536)
            refuse(format("item_bytes is %llu, expected 1 to 65536", llu(item_bytes)));
        if (!senders.empty()) require(in, "in");
        if (!receivers.empty()) require(out, "out");
        for (std::uint32_t i = 0; i < rank_count_; ++i)
            writers.emplace_back(&memory_).add(ItemsHeader{item_bytes, side});
        for (std::size_t i = 0; i < senders.size(); ++i)
            if (senders[i].rank == me)
                here.push_back(items + i * item_bytes);
            else
                writers[place_of(senders[i].rank)].add(items + i * item_bytes, item_bytes);
        for (std::uint32_t i = 0; i < rank_count_; ++i) out_[i] = writers[i].bytes();
    });
    exchange(nullptr, failure);
    failure.guard([&] {
        Array<Reader> readers(&memory_);
        for (std::uint32_t i = 0; i < rank_count_; ++i) {
            const auto items_of = readers.emplace_back(in_[i]).take<ItemsHeader>();
            if (items_of.bytes != item_bytes || items_of.from != side)
                refuse(format(
                    "rank %u sends items of %llu bytes from the side of %s, this rank items of %llu "
                    "bytes from that of %s",
                    ranks_[i], llu(items_of.bytes), name_of(items_of.from), llu(item_bytes), name_of(side)));
        }
        auto* result = static_cast<std::byte*>(out);
        auto next_here = here.begin();
        for (const vox_dist_contact& contact : receivers) {
            if (contact.rank == me) {
                std::memcpy(result, *next_here++, item_bytes);
            } else if (!readers[place_of(contact.rank)].take(result, item_bytes)) {
                throw Error(VOX_ERROR_INTERNAL, format("rank %u sent too little", contact.rank));
            }
            result += item_bytes;
        }
    });
    failure.agree(transport_);
}
