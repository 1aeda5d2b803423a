// Sorts items that belong to vertices, e.g. facets to their lowest vertex, in linear time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vox::io {

// Calls visit(bucket, first, last) for the sorted items of each bucket. `each` calls its argument with
// (bucket, item) for every item. It is called twice and must give the same items both times.
template <class Item, class Each, class Visit>
void sort_in_buckets(std::uint64_t bucket_count, const Each& each, const Visit& visit) {
    std::vector<std::uint64_t> ends(bucket_count + 1, 0);
    each([&](std::uint32_t bucket, const Item&) { ++ends[bucket + std::size_t{1}]; });
    for (std::uint64_t b = 0; b < bucket_count; ++b) ends[b + 1] += ends[b];
    std::vector<Item> items(ends[bucket_count]);
    each([&](std::uint32_t bucket, const Item& item) { items[ends[bucket]++] = item; });
    // ends[b] has moved from the start of bucket b to its end.
    std::uint64_t start = 0;
    for (std::uint64_t b = 0; b < bucket_count; ++b) {
        Item* const first = items.data() + start;
        Item* const last = items.data() + ends[b];
        std::sort(first, last);
        visit(static_cast<std::uint32_t>(b), first, last);
        start = ends[b];
    }
}

// The same, but calls visit(bucket, item, count) for each run of equal items.
template <class Item, class Each, class Visit>
void for_each_run(std::uint64_t bucket_count, const Each& each, const Visit& visit) {
    sort_in_buckets<Item>(bucket_count, each, [&](std::uint32_t bucket, const Item* first, const Item* last) {
        while (first != last) {
            const Item* const run = first;
            while (first != last && *first == *run) ++first;
            visit(bucket, *run, first - run);
        }
    });
}

} // namespace vox::io
