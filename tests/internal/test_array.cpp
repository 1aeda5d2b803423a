// base/array.hpp beside std::vector: the same calls give the same elements, whatever the type, and memory
// that runs out changes nothing.
#include "base/array.hpp"

#include <cstdint>
#include <memory_resource>
#include <new>
#include <string>
#include <vector>

#include "support/suite.h"

using vox::Array;

namespace {

// Counts what is taken, and gives no more than `left` times.
class Counting final : public std::pmr::memory_resource {
public:
    std::size_t taken = 0, left = SIZE_MAX;

private:
    void* do_allocate(std::size_t bytes, std::size_t alignment) override {
        if (left == 0) throw std::bad_alloc();
        --left;
        taken += bytes;
        return std::pmr::new_delete_resource()->allocate(bytes, alignment);
    }
    void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
        taken -= bytes;
        std::pmr::new_delete_resource()->deallocate(memory, bytes, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

template <class T>
T number(std::uint32_t n) {
    if constexpr (std::is_same_v<T, std::string>)
        return "a text that has memory of its own, number " + std::to_string(n);
    else
        return T(n);
}

template <class T>
void check_same(const Array<T>& array, const std::vector<T>& expected, const char* call) {
    ck_assert_msg(array.size() == expected.size() && std::equal(array.begin(), array.end(), expected.begin()),
                  "after %s", call);
    ck_assert_msg(array.capacity() >= array.size(), "after %s", call);
}

// A long life of both, by the same random calls.
template <class T>
void live_beside_vector() {
    Counting memory;
    {
        Array<T> array(&memory);
        std::vector<T> expected;
        std::uint32_t random = 1;
        const auto below = [&](std::size_t n) {
            random = random * 1664525 + 1013904223;
            return static_cast<std::size_t>(random >> 8) % n;
        };
        for (std::uint32_t i = 0; i < 20000; ++i) {
            const T value = number<T>(i);
            const std::size_t size = expected.size(), at = below(size + 1), count = below(5);
            const auto place = array.begin() + at;
            const auto other = expected.begin() + std::ptrdiff_t(at);
            const std::vector<T> some(count, value);
            switch (size > 200 ? 8 + below(5) : below(13)) {
            case 0:
                array.push_back(value), expected.push_back(value), check_same(array, expected, "push_back");
                break;
            case 1:
                if (size == 0) break;
                array.push_back(array[at % size]),
                    expected.push_back(T(expected[at % size])); // of the array itself
                check_same(array, expected, "push_back of its own");
                break;
            case 2:
                array.emplace_back(value), expected.emplace_back(value);
                break;
            case 3:
                array.insert(place, value), expected.insert(other, value),
                    check_same(array, expected, "insert");
                break;
            case 4:
                array.insert(place, some.begin(), some.end()),
                    expected.insert(other, some.begin(), some.end());
                check_same(array, expected, "insert of a range");
                break;
            case 5:
                array.resize(size + count), expected.resize(size + count),
                    check_same(array, expected, "resize");
                break;
            case 6:
                array.resize(size + count, value), expected.resize(size + count, value);
                check_same(array, expected, "resize with a value");
                break;
            case 7:
                array.reserve(size + count), expected.reserve(size + count),
                    check_same(array, expected, "reserve");
                break;
            case 8:
                array.resize(at), expected.resize(at), check_same(array, expected, "resize to less");
                break;
            case 9: {
                const std::size_t end = at + below(size - at + 1);
                array.erase(place, array.begin() + end),
                    expected.erase(other, expected.begin() + std::ptrdiff_t(end));
                check_same(array, expected, "erase");
                break;
            }
            case 10:
                array.assign(count, value), expected.assign(count, value),
                    check_same(array, expected, "assign");
                break;
            case 11: {
                const auto odd = [&](const T& item) { return item < value; };
                ck_assert_uint_eq(erase_if(array, odd), std::erase_if(expected, odd));
                check_same(array, expected, "erase_if");
                break;
            }
            case 12: {
                Array<T> copy(array, &memory), moved(std::move(array));
                ck_assert(copy == moved && array.empty() && array.capacity() == 0);
                array = std::move(moved);
                array.shrink_to_fit();
                ck_assert_uint_eq(array.capacity(), array.size());
                check_same(array, expected, "moves");
                break;
            }
            }
        }
        ck_assert_uint_ge(memory.taken, array.capacity() * sizeof(T));
    }
    ck_assert_uint_eq(memory.taken, 0);
}

START_TEST(beside_vector) {
    live_beside_vector<std::uint32_t>();
    live_beside_vector<double>();
    live_beside_vector<std::string>();
}
END_TEST

// Between memory resources elements move one by one, and each array keeps its own.
START_TEST(other_memory) {
    Counting here, there;
    Array<std::string> a({"one", "two"}, &here), b({"three"}, &there);
    a = std::move(b);
    ck_assert_uint_eq(a.size(), 1);
    ck_assert(a[0] == "three" && a.memory() == &here);
    const Array<std::string> copy(a, &there);
    ck_assert(copy == a && copy.memory() == &there);
}
END_TEST

template <class T>
void run_out() {
    Counting memory;
    Array<T> array({number<T>(1), number<T>(2), number<T>(3)}, &memory);
    array.shrink_to_fit();
    const Array<T> before(array, std::pmr::new_delete_resource());
    memory.left = 0;
    int failed = 0;
    const auto fails = [&](auto&& call) {
        try {
            call();
        } catch (const std::bad_alloc&) {
            ++failed;
        }
        ck_assert(array == before && array.capacity() == 3);
    };
    fails([&] { array.push_back(array[0]); });
    fails([&] { array.emplace_back(number<T>(7)); });
    fails([&] { array.insert(array.begin(), number<T>(7)); });
    fails([&] { array.resize(4); });
    fails([&] { array.resize(4, number<T>(7)); });
    fails([&] { array.reserve(4); });
    fails([&] { array.assign(4, number<T>(7)); });
    fails([&] { array.reserve(Array<T>::max_size() + 1); });
    ck_assert_int_eq(failed, 8);
    array.pop_back();
    array.shrink_to_fit();
    ck_assert_uint_eq(array.size(), 2);
    ck_assert_uint_eq(array.capacity(), 3);
}

// An element whose constructor throws is none, with room for it and without.
struct Refuses {
    std::string text = number<std::string>(1); // so that destroying one that is none shows
    explicit Refuses(bool refuses) {
        if (refuses) throw std::bad_alloc();
    }
};

START_TEST(constructors_that_throw) {
    Array<Refuses> array(std::pmr::new_delete_resource());
    for (std::size_t size = 0; size < 5; ++size) {
        bool thrown = false;
        try {
            array.emplace_back(true);
        } catch (const std::bad_alloc&) {
            thrown = true;
        }
        ck_assert(thrown);
        ck_assert_uint_eq(array.size(), size);
        array.emplace_back(false);
    }
}
END_TEST

START_TEST(memory_that_runs_out) {
    run_out<std::uint32_t>();
    run_out<std::string>();
}
END_TEST

} // namespace

SUITE(array) {
    TCase* tests = add_case(suite, "array");
    tcase_add_each(tests, beside_vector, other_memory, constructors_that_throw, memory_that_runs_out);
}
