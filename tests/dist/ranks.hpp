// Ranks as threads of one process.
#pragma once

#include <vox/vox_dist.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace scenes {

// Where the ranks meet. Each has one slot, which it fills before it arrives and keeps until all have arrived
// the next time.
class RankGroup {
public:
    struct Slot {
        const void* data = nullptr;
        std::uint64_t size = 0;
        const std::uint32_t* ranks = nullptr;
        const vox_dist_message* out = nullptr;
        std::vector<std::byte> received;
        std::uint64_t numbers[16] = {};
    };

    RankGroup(std::uint32_t size, std::uint32_t parallel) : size(size), slots(size), turns_(parallel) {}

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

    const std::uint32_t size;
    std::vector<Slot> slots;

private:
    void take_turn(std::unique_lock<std::mutex>& lock) {
        turn_.wait(lock, [&] { return turns_ > 0; });
        --turns_;
    }

    std::mutex mutex_;
    std::condition_variable changed_, turn_;
    std::uint32_t turns_, arrived_ = 0;
    std::uint64_t round_ = 0;
};

// The functions of a transport, whose `user` is one of these.
struct ThreadRank {
    RankGroup* group;
    std::uint32_t rank;
    RankGroup::Slot& slot() const { return group->slots[rank]; }

    static vox_result allgather(const void* in, std::uint64_t bytes, void* out, void* user) {
        const ThreadRank& me = *static_cast<ThreadRank*>(user);
        me.slot().data = in;
        me.group->arrive();
        for (std::uint32_t rank = 0; rank < me.group->size; ++rank)
            std::memcpy(static_cast<std::byte*>(out) + rank * bytes, me.group->slots[rank].data, bytes);
        me.group->arrive(); // all have read
        return VOX_OK;
    }
    static vox_result exchange(const std::uint32_t* ranks, std::uint32_t count, const vox_dist_message* out,
                               vox_dist_message* in, void* user) {
        const ThreadRank& me = *static_cast<ThreadRank*>(user);
        RankGroup::Slot& slot = me.slot();
        slot.ranks = ranks;
        slot.size = count;
        slot.out = out;
        me.group->arrive();
        const vox_result result = me.receive(ranks, count, in);
        me.group->arrive();
        return result;
    }
    static vox_result agree(std::uint64_t* minima, std::uint32_t minimum_count, std::uint64_t* sums,
                            std::uint32_t sum_count, void* user) {
        const ThreadRank& me = *static_cast<ThreadRank*>(user);
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

private:
    const vox_dist_message* message_of(std::uint32_t other) const {
        const RankGroup::Slot& from = group->slots[other];
        const std::uint32_t* place = std::find(from.ranks, from.ranks + from.size, rank);
        return place == from.ranks + from.size ? nullptr : from.out + (place - from.ranks);
    }
    vox_result receive(const std::uint32_t* ranks, std::uint32_t count, vox_dist_message* in) const {
        std::uint64_t total = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const vox_dist_message* message = message_of(ranks[i]);
            if (!message) return vox_fail(VOX_ERROR_INTERNAL, "a rank was named that does not name this one");
            total += message->size;
        }
        slot().received.resize(total);
        std::byte* at = slot().received.data();
        for (std::uint32_t i = 0; i < count; ++i) {
            const vox_dist_message message = *message_of(ranks[i]);
            if (message.size) std::memcpy(at, message.data, message.size);
            in[i] = {at, message.size};
            at += message.size;
        }
        return VOX_OK;
    }
};

// Runs `function` for `size` ranks, each on a thread of its own. At most `parallel` of them run at the same
// time, the others wait for their turn: with 1, as if on one thread.
inline void run_ranks(std::uint32_t size, std::uint32_t parallel,
                      const std::function<void(const vox_dist_transport*)>& function) noexcept {
    RankGroup group(size, parallel);
    const auto run = [&](std::uint32_t rank) {
        ThreadRank me{&group, rank};
        vox_dist_transport transport{};
        transport.struct_size = sizeof transport;
        transport.rank = rank;
        transport.size = size;
        transport.allgather = ThreadRank::allgather;
        transport.exchange = ThreadRank::exchange;
        transport.agree = ThreadRank::agree;
        transport.user = &me;
        group.begin_turn();
        function(&transport);
        group.end_turn();
    };
    std::vector<std::thread> threads;
    for (std::uint32_t rank = 0; rank < size; ++rank) threads.emplace_back(run, rank);
    for (std::thread& thread : threads) thread.join();
}

} // namespace scenes
