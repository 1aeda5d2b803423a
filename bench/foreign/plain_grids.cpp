// Three plain grids as anybody writes them, and a count of what a grid does. A library for bench/foreign's
// Python, which times the calls. Boxes are six doubles: the low corner, then the high one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <vector>

#if defined(_WIN32)
#define EXPORTED extern "C" __declspec(dllexport)
#else
#define EXPORTED extern "C" __attribute__((visibility("default")))
#endif

namespace {

enum class Stored { box = 1, centre = 2 };             // as vox_cells_stored
enum class Queried { box = 1, around = 2, pairs = 3 }; // as vox_cells_queried

using Point = std::array<double, 3>;
using Cell = std::array<std::int64_t, 3>;

struct Box {
    Point low, high;
};

struct Range { // of cells, both ends included; none where a first is behind its last
    Cell first, last;

    std::uint64_t count() const {
        std::uint64_t cells = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            cells *= static_cast<std::uint64_t>(std::max<std::int64_t>(last[a] - first[a] + 1, 0));
        }
        return cells;
    }
};

struct Boxes {
    const Box* data;
    std::size_t count;

    const Box* begin() const { return data; }
    const Box* end() const { return data + count; }
};

bool meet(const Box& a, const Box& b) {
    return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] && b.low[1] <= a.high[1] &&
           a.low[2] <= b.high[2] && b.low[2] <= a.high[2];
}

Point centre(const Box& box) {
    return {0.5 * (box.low[0] + box.high[0]), 0.5 * (box.low[1] + box.high[1]),
            0.5 * (box.low[2] + box.high[2])};
}

Box bounds_of(Boxes boxes) {
    Box all = boxes.data[0];
    for (const Box& box : boxes) {
        for (std::size_t a = 0; a < 3; ++a) {
            all.low[a] = std::min(all.low[a], box.low[a]);
            all.high[a] = std::max(all.high[a], box.high[a]);
        }
    }
    return all;
}

struct Lattice {
    Point origin;
    double inverse; // of the cell size

    Cell cell(const Point& p) const {
        Cell c;
        for (std::size_t a = 0; a < 3; ++a) {
            const double x = (p[a] - origin[a]) * inverse;
            c[a] = static_cast<std::int64_t>(x);
            c[a] -= static_cast<double>(c[a]) > x; // rounded down
        }
        return c;
    }

    Range stored(const Box& box, Stored cells_stored) const {
        if (cells_stored == Stored::centre) {
            const Cell c = cell(centre(box));
            return {c, c};
        }
        return {cell(box.low), cell(box.high)};
    }

    Range queried(const Box& box, Queried cells_queried) const {
        if (cells_queried == Queried::around) {
            const Cell c = cell(centre(box));
            return {{c[0] - 1, c[1] - 1, c[2] - 1}, {c[0] + 1, c[1] + 1, c[2] + 1}};
        }
        return {cell(box.low), cell(box.high)};
    }
};

template <typename Function>
void for_each_cell(const Range& range, const Function& function) {
    for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z) {
        for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
            for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) {
                function(Cell{x, y, z});
            }
        }
    }
}

// A dense lattice over some bounds, its cells numbered from 0.
struct DenseLattice {
    Lattice lattice;
    Cell size;

    DenseLattice(const Box& bounds, double cell_size, const Point& origin) : lattice{origin, 1 / cell_size} {
        const Cell low = lattice.cell(bounds.low), high = lattice.cell(bounds.high);
        for (std::size_t a = 0; a < 3; ++a) {
            lattice.origin[a] += static_cast<double>(low[a]) * cell_size;
            size[a] = high[a] - low[a] + 1;
        }
    }

    std::size_t cells() const { return static_cast<std::size_t>(size[0] * size[1] * size[2]); }
    std::size_t number(const Cell& c) const {
        return static_cast<std::size_t>((c[2] * size[1] + c[1]) * size[0] + c[0]);
    }

    Range clipped(Range range) const {
        for (std::size_t a = 0; a < 3; ++a) {
            range.first[a] = std::max<std::int64_t>(range.first[a], 0);
            range.last[a] = std::min<std::int64_t>(range.last[a], size[a] - 1);
        }
        return range;
    }
};

// Of a pair that shares several cells, the one in which it is reported: the first.
bool reports(const Cell& first_of_a, const Cell& first_of_b, const Cell& here) {
    return std::max(first_of_a[0], first_of_b[0]) == here[0] &&
           std::max(first_of_a[1], first_of_b[1]) == here[1] &&
           std::max(first_of_a[2], first_of_b[2]) == here[2];
}

// A counting sort into a dense lattice; its memory is kept from run to run.
class SortedGrid {
public:
    std::uint64_t run(Boxes stored, Boxes querying, double cell_size, Stored cells_stored,
                      Queried cells_queried) {
        const Box bounds = bounds_of(stored);
        const DenseLattice dense(bounds, cell_size, bounds.low);
        ends_.assign(dense.cells() + 1, 0);
        ranges_.clear();
        for (const Box& box : stored) {
            ranges_.push_back(dense.clipped(dense.lattice.stored(box, cells_stored)));
            for_each_cell(ranges_.back(), [&](const Cell& c) { ++ends_[dense.number(c) + 1]; });
        }
        for (std::size_t i = 1; i < ends_.size(); ++i) {
            ends_[i] += ends_[i - 1];
        }
        entries_.resize(ends_.back());
        // Each start moves to its end, which is the start of the next.
        for (std::size_t i = 0; i < stored.count; ++i) {
            for_each_cell(ranges_[i], [&](const Cell& c) {
                entries_[ends_[dense.number(c)]++] = static_cast<std::uint32_t>(i);
            });
        }
        std::uint64_t found = 0;
        for (const Box& box : querying) {
            const Range range = dense.clipped(dense.lattice.queried(box, cells_queried));
            for_each_cell(range, [&](const Cell& c) {
                const std::size_t cell = dense.number(c);
                for (std::size_t k = cell == 0 ? 0 : ends_[cell - 1]; k < ends_[cell]; ++k) {
                    const std::uint32_t i = entries_[k];
                    found += meet(box, stored.data[i]) &&
                             (cells_stored == Stored::centre || reports(range.first, ranges_[i].first, c));
                }
            });
        }
        return found;
    }

private:
    std::vector<Range> ranges_; // of cells, of each that is stored
    std::vector<std::uint32_t> ends_, entries_;
};

struct HashOfCell {
    std::size_t operator()(const Cell& c) const {
        return static_cast<std::size_t>((c[0] * 73856093) ^ (c[1] * 19349663) ^ (c[2] * 83492791));
    }
};

using Lists = std::unordered_map<Cell, std::vector<std::uint32_t>, HashOfCell>;

std::uint64_t run_hashed(Boxes stored, Boxes querying, double cell_size, Stored cells_stored,
                         Queried cells_queried) {
    const Lattice lattice{{0, 0, 0}, 1 / cell_size};
    Lists lists;
    std::vector<Cell> firsts; // of each that is stored
    for (std::size_t i = 0; i < stored.count; ++i) {
        const Range range = lattice.stored(stored.data[i], cells_stored);
        firsts.push_back(range.first);
        for_each_cell(range, [&](const Cell& c) { lists[c].push_back(static_cast<std::uint32_t>(i)); });
    }
    std::uint64_t found = 0;
    for (const Box& box : querying) {
        const Range range = lattice.queried(box, cells_queried);
        for_each_cell(range, [&](const Cell& c) {
            const auto list = lists.find(c);
            if (list != lists.end()) {
                for (const std::uint32_t i : list->second) {
                    found += meet(box, stored.data[i]) &&
                             (cells_stored == Stored::centre || reports(range.first, firsts[i], c));
                }
            }
        });
    }
    return found;
}

} // namespace

// A run of a grid: all of `stored` are stored in cells, all of `querying` look for those they meet. Returns
// how many pairs that are. cells_queried is box or around.
EXPORTED std::uint64_t plain_run_sorted(const double* stored, std::size_t stored_count,
                                        const double* querying, std::size_t querying_count, double cell_size,
                                        int cells_stored, int cells_queried) {
    static SortedGrid grid;
    return grid.run({reinterpret_cast<const Box*>(stored), stored_count},
                    {reinterpret_cast<const Box*>(querying), querying_count}, cell_size,
                    static_cast<Stored>(cells_stored), static_cast<Queried>(cells_queried));
}

EXPORTED std::uint64_t plain_run_hashed(const double* stored, std::size_t stored_count,
                                        const double* querying, std::size_t querying_count, double cell_size,
                                        int cells_stored, int cells_queried) {
    return run_hashed({reinterpret_cast<const Box*>(stored), stored_count},
                      {reinterpret_cast<const Box*>(querying), querying_count}, cell_size,
                      static_cast<Stored>(cells_stored), static_cast<Queried>(cells_queried));
}

// Points (three doubles) in hashed voxels, each asking for all others within `radius`.
EXPORTED std::uint64_t plain_run_voxels(const double* points, std::size_t count, double radius,
                                        double cell_size) {
    const Point* p = reinterpret_cast<const Point*>(points);
    const Lattice lattice{{0, 0, 0}, 1 / cell_size};
    Lists lists;
    for (std::size_t i = 0; i < count; ++i) {
        lists[lattice.cell(p[i])].push_back(static_cast<std::uint32_t>(i));
    }
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Box ball{{p[i][0] - radius, p[i][1] - radius, p[i][2] - radius},
                       {p[i][0] + radius, p[i][1] + radius, p[i][2] + radius}};
        for_each_cell(lattice.queried(ball, Queried::box), [&](const Cell& c) {
            const auto list = lists.find(c);
            if (list == lists.end()) {
                return;
            }
            for (const std::uint32_t j : list->second) {
                const double x = p[j][0] - p[i][0], y = p[j][1] - p[i][1], z = p[j][2] - p[i][2];
                found += x * x + y * y + z * z <= radius * radius;
            }
        });
    }
    return found;
}

// What a run does (the fields of vox_foreign_counts), the mean over `samples` positions of the lattice.
EXPORTED void plain_count(const double* stored_data, std::size_t stored_count, const double* querying_data,
                          std::size_t querying_count, double cell_size, int cells_stored, int cells_queried,
                          int samples, double* counts) {
    const Boxes stored{reinterpret_cast<const Box*>(stored_data), stored_count};
    const Boxes querying{reinterpret_cast<const Box*>(querying_data), querying_count};
    const Box bounds = bounds_of(stored);
    const auto which = static_cast<Queried>(cells_queried);
    double entries = 0, visits = 0, empty = 0, reads = 0, occupied = 0, cells = 0;
    std::vector<std::uint32_t> lengths;
    for (int s = 0; s < samples; ++s) {
        // Positions that fill the cell evenly: multiples of the generalised golden ratio.
        const double shift[] = {0.8191725134, 0.6710436067, 0.5497004779};
        Point origin = bounds.low;
        for (std::size_t a = 0; a < 3; ++a) {
            const double part = shift[a] * (s + 1);
            origin[a] -= (part - std::floor(part)) * cell_size;
        }
        const DenseLattice dense(bounds, cell_size, origin);
        lengths.assign(dense.cells(), 0);
        for (const Box& box : stored) {
            for_each_cell(dense.clipped(dense.lattice.stored(box, static_cast<Stored>(cells_stored))),
                          [&](const Cell& c) {
                              ++lengths[dense.number(c)];
                              ++entries;
                          });
        }
        cells += static_cast<double>(dense.cells());
        for (const std::uint32_t length : lengths) {
            occupied += length > 0;
            if (which == Queried::pairs && length > 0) {
                ++visits;
                reads += 0.5 * length * (length - 1.0);
            }
        }
        if (which == Queried::pairs) {
            continue;
        }
        for (const Box& box : querying) {
            const Range wanted = dense.lattice.queried(box, which);
            const Range inside = dense.clipped(wanted);
            visits += static_cast<double>(wanted.count() - inside.count());
            empty += static_cast<double>(wanted.count() - inside.count());
            for_each_cell(inside, [&](const Cell& c) {
                const std::uint32_t length = lengths[dense.number(c)];
                ++visits;
                empty += length == 0;
                reads += length;
            });
        }
    }
    const double sums[] = {entries, visits, empty, reads, occupied, cells};
    for (std::size_t i = 0; i < std::size(sums); ++i) {
        counts[i] = sums[i] / samples;
    }
}
