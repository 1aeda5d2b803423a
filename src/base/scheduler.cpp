#include "base/scheduler.hpp"

#include <algorithm>

#if defined(VOX_TBB)
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#elif defined(VOX_SCHEDULER_THREADS)
#include "base/clock.hpp"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#if defined(_MSC_VER)
#include <intrin.h>
#endif
#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#define VOX_CAN_FORK 1
#endif
#endif

namespace vox {

#if defined(VOX_TBB)

struct Scheduler::Pool : tbb::task_arena {
    using task_arena::task_arena;
};

// oneTBB has no more threads than cores, and prints a warning if more are requested.
std::uint32_t Scheduler::most_workers(std::uint32_t asked) {
    if (asked == 1) return 1;
    const int cores = tbb::task_arena(tbb::task_arena::automatic).max_concurrency();
    const std::uint32_t most =
        std::clamp<std::uint32_t>(static_cast<std::uint32_t>(cores), 1, VOX_MAX_WORKERS);
    return asked == 0 ? most : std::min(asked, most);
}

Scheduler::Scheduler(std::uint32_t worker_count)
    : pool_(std::make_unique<Pool>(static_cast<int>(worker_count))) {}

Scheduler::~Scheduler() = default;

void Scheduler::run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context) {
    pool_->execute([&] {
        using Range = tbb::blocked_range<std::uint64_t>;
        // Isolated, so that it is not cancelled with the caller's tasks.
        tbb::task_group_context context_of_task(tbb::task_group_context::isolated);
        tbb::parallel_for(
            Range(0, items, std::max<std::uint64_t>(min_range, 1)),
            [&](const Range& range) {
                const int worker = tbb::this_task_arena::current_thread_index();
                task(range.begin(), range.end(), static_cast<std::uint32_t>(worker), context);
            },
            context_of_task);
    });
}

#elif defined(VOX_SCHEDULER_THREADS)

namespace {

// How long a thread spins before it sleeps: the next task of the step mostly comes sooner, and waking a
// thread takes as long.
constexpr std::uint64_t patience_ns = 30'000;

void relax() noexcept {
#if defined(_MSC_VER) && (defined(_M_X64) || defined(_M_IX86))
    _mm_pause();
#elif defined(__GNUC__) && (defined(__x86_64__) || defined(__i386__))
    __builtin_ia32_pause();
#elif defined(__GNUC__) && defined(__aarch64__)
    asm volatile("isb");
#endif
}

// Spins. Whether `ready` became true within patience_ns.
template <class Ready>
bool came_soon(Ready&& ready) noexcept {
    const std::uint64_t end = nanoseconds() + patience_ns;
    do {
        for (int i = 0; i < 32; ++i) {
            if (ready()) return true;
            relax();
        }
        std::this_thread::yield(); // to the awaited thread, if it shares this core
    } while (nanoseconds() < end);
    return false;
}

} // namespace

// The caller of run() is worker 0. It announces a task with the number of threads that can help, takes part,
// and when no range is left, withdraws the offer and waits for the threads that accepted it. So a late thread
// is not waited for, and never sees a task that has ended.
struct Scheduler::Pool {
    explicit Pool(std::uint32_t workers) : worker_count(workers) { threads_.reserve(workers - 1); }

    ~Pool() {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        wake_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }

    // True if this is a copy, made by fork, of a pool whose threads are in the parent. Such a pool cannot be
    // used, and not even destroyed.
    bool is_parents() const noexcept {
#if defined(VOX_CAN_FORK)
        return !threads_.empty() && process_ != getpid();
#else
        return false;
#endif
    }

    // True if the system gave too few threads. It may give a new pool more.
    bool lacks_threads() const noexcept { return tried_ && threads_.size() + 1 < worker_count; }

    void run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context) {
        make_threads();
        task_ = task;
        context_ = context;
        items_ = items;
        least_ = std::max<std::uint64_t>(min_range, 1);
        taken_.store(0, std::memory_order_relaxed);
        const std::uint64_t ranges = std::max<std::uint64_t>(items / least_, 1);
        announce(static_cast<std::uint32_t>(std::min<std::uint64_t>(threads_.size(), ranges - 1)));
        work(0);
        withdraw();
    }

    const std::uint32_t worker_count;

private:
    // The two halves of state_.
    static constexpr std::uint32_t one_offer = 1u << 16, members = one_offer - 1;

    void make_threads() {
        if (tried_) return;
        tried_ = true;
#if defined(VOX_CAN_FORK)
        process_ = getpid();
#endif
        try {
            for (std::uint32_t worker = 1; worker < worker_count; ++worker)
                threads_.emplace_back(&Pool::serve, this, worker);
        } catch (const std::exception&) { // no more threads or no memory: the others do all
        }
    }

    // ---- on the caller's thread ----

    void announce(std::uint32_t offers) {
        state_.store(offers * one_offer);
        // A thread counts itself as asleep before it reads state_ for the last time; so one of the two sees
        // the other.
        const std::uint32_t asleep = asleep_.load();
        if (asleep == 0 || offers == 0) return;
        { const std::lock_guard lock(mutex_); } // threads that have read state_ are waiting now
        if (offers >= asleep)
            wake_.notify_all();
        else
            for (std::uint32_t i = 0; i < offers; ++i) wake_.notify_one();
    }

    void withdraw() {
        const auto all_left = [&] { return state_.load() == 0; };
        state_.fetch_and(members);
        if (came_soon(all_left)) return;
        std::unique_lock lock(mutex_);
        caller_waits_ = true;
        left_.wait(lock, all_left);
        caller_waits_ = false;
    }

    // ---- on the pool's threads ----

    void serve(std::uint32_t worker) {
        const auto wanted = [&] { return state_.load() >= one_offer || stop_.load(); };
        for (;;) {
            if (!came_soon(wanted)) {
                std::unique_lock lock(mutex_);
                ++asleep_;
                wake_.wait(lock, wanted);
                --asleep_;
            }
            if (stop_.load()) return;
            if (!join()) continue;
            work(worker);
            leave();
        }
    }

    bool join() {
        std::uint32_t state = state_.load();
        do {
            if (state < one_offer) return false;
        } while (!state_.compare_exchange_weak(state, state - one_offer + 1));
        return true;
    }

    void leave() {
        if (--state_ != 0 || !caller_waits_.load()) return;
        { const std::lock_guard lock(mutex_); }
        left_.notify_one();
    }

    // ---- on both ----

    // Ranges become smaller towards the end, so that all workers end together.
    bool take(std::uint64_t& begin, std::uint64_t& end) {
        const std::uint64_t shares = 4 * (threads_.size() + 1);
        begin = taken_.load(std::memory_order_relaxed);
        do {
            if (begin >= items_) return false;
            const std::uint64_t left = items_ - begin, size = std::max(least_, left / shares);
            end = left - std::min(left, size) < least_ ? items_ : begin + size;
        } while (!taken_.compare_exchange_weak(begin, end, std::memory_order_relaxed));
        return true;
    }

    void work(std::uint32_t worker) {
        for (std::uint64_t begin = 0, end = 0; take(begin, end);) task_(begin, end, worker, context_);
    }

    // The task, written by the caller while nobody is a member.
    vox_task* task_ = nullptr;
    void* context_ = nullptr;
    std::uint64_t items_ = 0, least_ = 1;

    alignas(64) std::atomic<std::uint64_t> taken_ = 0; // items handed out
    // High: threads that may still join the task. Low: those that have joined and not left.
    alignas(64) std::atomic<std::uint32_t> state_ = 0;
    std::atomic<std::uint32_t> asleep_ = 0;
    std::atomic<bool> caller_waits_ = false, stop_ = false;

    alignas(64) std::mutex mutex_;
    std::condition_variable wake_, left_; // for a task, or the end; for the last member to leave
    std::vector<std::thread> threads_;
    bool tried_ = false; // to make the threads
#if defined(VOX_CAN_FORK)
    pid_t process_ = 0;
#endif
};

std::uint32_t Scheduler::most_workers(std::uint32_t asked) {
    if (asked == 1) return 1;
    const std::uint32_t most =
        std::clamp<std::uint32_t>(std::thread::hardware_concurrency(), 1, VOX_MAX_WORKERS);
    return asked == 0 ? most : std::min(asked, most);
}

Scheduler::Scheduler(std::uint32_t worker_count) : pool_(std::make_unique<Pool>(worker_count)) {}

Scheduler::~Scheduler() {
    if (pool_->is_parents()) (void)pool_.release();
}

void Scheduler::run(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context) {
    if (pool_->is_parents()) {
        auto childs = std::make_unique<Pool>(pool_->worker_count);
        (void)pool_.release();
        pool_ = std::move(childs);
    }
    pool_->run(task, items, min_range, context);
}

#else

struct Scheduler::Pool {};

std::uint32_t Scheduler::most_workers(std::uint32_t) { return 1; }

Scheduler::Scheduler(std::uint32_t) {}

Scheduler::~Scheduler() = default;

void Scheduler::run(vox_task* task, std::uint64_t items, std::uint64_t, void* context) {
    task(0, items, 0, context);
}

#endif

// On Windows, a thread that ends waits until a library is unloaded, which would wait for the thread.
#if defined(VOX_SCHEDULER_THREADS) && !defined(_WIN32)

namespace {

// No mutex: a fork could copy it locked. A copied scheduler makes threads of its own.
constinit std::atomic<Scheduler*> last_calls = nullptr;
// True if at_end was destroyed. Grids may be stepped after that, in the destructors of other objects.
constinit std::atomic<bool> has_ended = false;

struct AtEnd {
    ~AtEnd() {
        has_ended = true;
        delete last_calls.exchange(nullptr);
    }
} at_end;

} // namespace

std::unique_ptr<Scheduler> Scheduler::of_last_call(std::uint32_t worker_count) {
    std::unique_ptr<Scheduler> last(last_calls.exchange(nullptr));
    if (last && last->pool_->worker_count == worker_count) return last;
    return std::make_unique<Scheduler>(worker_count);
}

void Scheduler::leave(std::unique_ptr<Scheduler> scheduler) noexcept {
    if (scheduler->pool_->lacks_threads()) return;
    delete last_calls.exchange(scheduler.release());
    if (has_ended) delete last_calls.exchange(nullptr);
}

#else

std::unique_ptr<Scheduler> Scheduler::of_last_call(std::uint32_t worker_count) {
    return std::make_unique<Scheduler>(worker_count);
}

void Scheduler::leave(std::unique_ptr<Scheduler>) noexcept {}

#endif

} // namespace vox
