// Ranks as threads of one process.
#include "base/border.hpp"
#include "base/structs.hpp"
#include "dist/messages.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

namespace vox::dist {
namespace {

// Where the ranks meet. Each has one list of messages, which it fills before it arrives and keeps until all
// have arrived the next time; so two lists take turns.
class RankGroup {
public:
    RankGroup(std::uint32_t size, std::uint32_t parallel) : size(size), turns_(parallel), slots(size) {}

    void begin_turn() {
        std::unique_lock lock(mutex_);
        take_turn(lock);
    }
    void end_turn() {
        const std::lock_guard lock(mutex_);
        ++turns_;
        turn_.notify_one();
    }
    // Returns when all ranks have arrived; the others run meanwhile.
    void arrive() {
        std::unique_lock lock(mutex_);
        ++turns_;
        turn_.notify_one();
        const std::uint64_t round = round_;
        if (++arrived_ == size) {
            arrived_ = 0;
            ++round_;
            changed_.notify_all();
        } else {
            changed_.wait(lock, [&] { return round_ != round; });
        }
        take_turn(lock);
    }
    // All threads were started, or none of them is to do anything.
    bool wait_for_start() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return start_ != 0; });
        return start_ > 0;
    }
    void start(int how) {
        const std::lock_guard lock(mutex_);
        start_ = how;
        changed_.notify_all();
    }

    const std::uint32_t size;

private:
    void take_turn(std::unique_lock<std::mutex>& lock) {
        turn_.wait(lock, [&] { return turns_ > 0; });
        --turns_;
    }

    std::mutex mutex_;
    std::condition_variable changed_, turn_;
    std::uint32_t turns_, arrived_ = 0;
    std::uint64_t round_ = 0;
    int start_ = 0; // 1: go; -1: give up

public:
    struct Slot {
        const void* data = nullptr;
        std::uint64_t size = 0;
        const std::uint32_t* ranks = nullptr;
        const vox_bytes* out = nullptr;
        std::vector<std::byte> received;
        std::uint64_t numbers[16] = {};
    };
    std::vector<Slot> slots;
};

struct Rank {
    RankGroup* group;
    std::uint32_t rank;
    RankGroup::Slot& slot() const { return group->slots[rank]; }
};

vox_result allgather(const void* in, std::uint64_t bytes, void* out, void* user) {
    const Rank& me = *static_cast<Rank*>(user);
    me.slot().data = in;
    me.group->arrive();
    for (std::uint32_t rank = 0; rank < me.group->size; ++rank)
        std::memcpy(static_cast<std::byte*>(out) + rank * bytes, me.group->slots[rank].data, bytes);
    me.group->arrive(); // all have read
    return VOX_OK;
}

vox_result exchange(const std::uint32_t* ranks, std::uint32_t count, const vox_bytes* out, vox_bytes* in,
                    void* user) {
    const Rank& me = *static_cast<Rank*>(user);
    RankGroup::Slot& slot = me.slot();
    slot.ranks = ranks;
    slot.size = count;
    slot.out = out;
    me.group->arrive();
    const auto message_of = [&](std::uint32_t other) -> const vox_bytes* {
        const RankGroup::Slot& from = me.group->slots[other];
        const std::uint32_t* place = std::find(from.ranks, from.ranks + from.size, me.rank);
        return place == from.ranks + from.size ? nullptr : from.out + (place - from.ranks);
    };
    const vox_result result = border([&] {
        std::uint64_t total = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const vox_bytes* message = message_of(ranks[i]);
            if (!message) throw Error(VOX_ERROR_INTERNAL, "a rank was named that does not name this one");
            total += message->size;
        }
        slot.received.resize(total);
        std::byte* at = slot.received.data();
        for (std::uint32_t i = 0; i < count; ++i) {
            const vox_bytes message = *message_of(ranks[i]);
            if (message.size) std::memcpy(at, message.data, message.size);
            in[i] = {at, message.size};
            at += message.size;
        }
    });
    me.group->arrive();
    return result;
}

vox_result agree(std::uint64_t* minima, std::uint32_t minimum_count, std::uint64_t* sums,
                 std::uint32_t sum_count, void* user) {
    const Rank& me = *static_cast<Rank*>(user);
    std::uint64_t* numbers = me.slot().numbers;
    std::copy(minima, minima + minimum_count, numbers);
    std::copy(sums, sums + sum_count, numbers + 8);
    me.group->arrive();
    for (std::uint32_t i = 0; i < minimum_count; ++i)
        for (const RankGroup::Slot& other : me.group->slots)
            minima[i] = std::min(minima[i], other.numbers[i]);
    for (std::uint32_t i = 0; i < sum_count; ++i) {
        sums[i] = 0;
        for (const RankGroup::Slot& other : me.group->slots) sums[i] += other.numbers[8 + i];
    }
    me.group->arrive();
    return VOX_OK;
}

} // namespace
} // namespace vox::dist

using namespace vox;

vox_result vox_transport_run(uint32_t size, uint32_t parallel, vox_rank_function* function, void* user) {
    return border([&] {
        if (!function) refuse("function is null");
        if (size == 0 || size > 4096) refuse(format("size is %u, expected 1 to 4096", size));
        dist::RankGroup group(size, parallel == 0 ? size : parallel);
        const auto run = [&](std::uint32_t rank) {
            if (!group.wait_for_start()) return;
            dist::Rank me{&group, rank};
            const vox_transport transport{sizeof transport, rank,           size,        0,
                                          dist::allgather,  dist::exchange, dist::agree, &me};
            group.begin_turn();
            function(&transport, user);
            group.end_turn();
        };
        std::vector<std::thread> threads;
        threads.reserve(size);
        bool all = true;
        try {
            for (std::uint32_t rank = 0; rank < size; ++rank) threads.emplace_back(run, rank);
        } catch (const std::system_error&) {
            all = false;
        }
        group.start(all ? 1 : -1);
        for (std::thread& thread : threads) thread.join();
        if (!all) throw Error(VOX_ERROR_OUT_OF_MEMORY, "the system gives no thread for each rank");
    });
}
