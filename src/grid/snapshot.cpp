#include "grid/snapshot.hpp"

#include "mesh/ids.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace vox {

// Of GRID.
constexpr std::uint32_t reference_engine = 1, fast_engine = 2, hashed_cells = 1, dense_cells = 2;
constexpr std::uint32_t live_bit = 1u << 31; // of a slot's word; the generation is in the others

// ---- GRID: settings -------------------------------------------------------------------------------

void Snapshot::save_settings(const vox_grid& grid, SnapshotWriter& out) {
    const ReferenceSettings& settings = grid.settings_;
    out.begin_chunk("GRID");
    out.u32(grid.fast_ ? fast_engine : reference_engine);
    out.u32(settings.dense ? dense_cells : hashed_cells);
    out.u32(settings.paper_hash ? 1 : 0);
    out.u32(grid.flags());
    out.u64(settings.hash_table_size);
    out.point(settings.world_min);
    out.point(settings.world_max);
    out.real(grid.used_cell_size_);
    out.u32(grid.chooses_cell_size());
    out.u32(grid.constraints_->most_per_pair());
    out.u64(grid.epoch_);
    out.end_chunk();
}

vox_grid_desc Snapshot::read_settings(SnapshotChunk& in, vox_grid_desc desc, vox_reference_desc& reference,
                                      vox_grid* grid) {
    const auto enumerator = [&](std::uint32_t last, const char* what) {
        const std::uint32_t value = in.u32();
        if (value > last) in.refuse(format("%s is %" PRIu32 ", expected 0 to %" PRIu32, what, value, last));
        return value;
    };
    const std::uint32_t engine = enumerator(fast_engine, "engine");
    if (engine == 0) in.refuse("engine is 0, expected the one in use");
    reference = vox_default_reference_desc();
    if (enumerator(dense_cells, "storage") == dense_cells) reference.flags |= VOX_REFERENCE_DENSE;
    if (enumerator(1, "hash") == 1) reference.flags |= VOX_REFERENCE_PAPER_HASH;
    if (engine == reference_engine && !desc.reference) desc.reference = &reference;
    desc.flags = in.u32();
    reference.hash_table_size = in.u64();
    for (double& x : reference.world_min) x = in.real<double>();
    for (double& x : reference.world_max) x = in.real<double>();
    const double cell_size = in.real<double>();
    if (!(cell_size >= 0) || std::isinf(cell_size))
        in.refuse(format("cell size is %g, expected a finite number >= 0", cell_size));
    const bool choose = in.flag("whether the cell size was chosen");
    if (!choose && cell_size == 0) in.refuse("cell size is 0, but not to be chosen");
    desc.cell_size = choose ? 0 : cell_size;
    desc.max_constraints_per_pair = in.u32();
    const std::uint64_t epoch = in.u64();
    in.end();
    if (grid) { // what a vox_grid_desc does not hold
        grid->used_cell_size_ = cell_size;
        grid->epoch_ = epoch;
    }
    try {
        check_grid_desc(desc);
        vox_grid_desc saved = desc;
        saved.reference = &reference; // also of a fast grid
        check_grid_desc(saved);
    } catch (const Error& error) {
        in.refuse(error.what());
    }
    return desc;
}

void Snapshot::load_settings(SnapshotChunk& in, Loading& to) {
    vox_reference_desc reference;
    (void)read_settings(in, vox_default_grid_desc(), reference, &to.grid);
}

// ---- SLOT: mesh slots, their generations, and which of them is taken next -------------------------

void Snapshot::save_slots(const vox_grid& grid, SnapshotWriter& out) {
    out.begin_chunk("SLOT");
    out.u32(static_cast<std::uint32_t>(grid.meshes_.slots_.size()));
    out.u32(static_cast<std::uint32_t>(grid.meshes_.free_slots_.size()));
    for (std::size_t s = 0; s < grid.meshes_.slots_.size(); ++s) {
        const MeshSlot& slot = grid.meshes_.slots_[s];
        out.u32(slot.generation | (slot.live ? live_bit : 0));
    }
    for (const std::uint32_t slot : grid.meshes_.free_slots_) out.u32(slot);
    out.end_chunk();
}

void Snapshot::load_slots(SnapshotChunk& in, Loading& to) {
    const std::uint32_t slots = in.u32(), free = in.u32();
    if (slots > VOX_MAX_BODIES)
        in.refuse(format("%" PRIu32 " slots, the limit is %" PRIu32, slots, VOX_MAX_BODIES));
    in.expect(std::uint64_t{slots} + free, 4, "slots");

    vox_grid& grid = to.grid;
    grid.meshes_.slots_.reserve(slots);
    grid.meshes_.free_slots_.reserve(slots);
    to.awaited.reserve(slots);
    std::uint32_t reusable = 0;
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        const std::uint32_t word = in.u32(), generation = word & ~live_bit;
        if (generation == 0 || generation > most_generations)
            in.refuse(format("slot %" PRIu32 " has generation %" PRIu32 ", expected 1 to %" PRIu32, slot,
                             generation, most_generations));
        grid.meshes_.slots_.emplace_back(&grid.memory_, generation);
        if (word & live_bit)
            to.awaited.push_back(make_id(slot, generation));
        else
            reusable += generation < most_generations;
    }
    if (free != reusable)
        in.refuse(format("%" PRIu32 " free slots are listed, %" PRIu32 " are free", free, reusable));

    Array<bool> listed(slots, false, &grid.memory_);
    for (const vox_body id : to.awaited) listed[slot_of(id)] = true;
    to.free_slots.reserve(slots);
    for (std::uint32_t i = 0; i < free; ++i) {
        const std::uint32_t slot = in.u32();
        if (slot >= slots) in.refuse(format("free slot %" PRIu32 " of %" PRIu32 " slots", slot, slots));
        if (listed[slot] || grid.meshes_.slots_[slot].generation == most_generations)
            in.refuse(format("slot %" PRIu32 " is listed as free, but it is taken, retired or listed before",
                             slot));
        listed[slot] = true;
        to.free_slots.push_back(slot);
    }
    in.end();
}

// ---- PAIR: pairs of meshes that do not collide ---------------------------------------------------

void Snapshot::save_exceptions(const vox_grid& grid, SnapshotWriter& out) {
    out.begin_chunk("PAIR");
    for_each_mesh(grid, [&](vox_body id, const Mesh& mesh) {
        for (const vox_body other : mesh.exceptions())
            if (id < other) {
                out.u32(id);
                out.u32(other);
            }
    });
    out.end_chunk();
}

void Snapshot::load_exceptions(SnapshotChunk& in, Loading& to) {
    vox_body last_a = VOX_NULL_BODY, last_b = VOX_NULL_BODY;
    while (in.left() > 0) {
        const vox_body a = in.u32(), b = in.u32();
        if (a >= b || std::tie(last_a, last_b) >= std::tie(a, b))
            in.refuse(format("pair (%" PRIu32 ", %" PRIu32 ") is out of order", a, b));
        or_refuse(in, a, [&] { to.grid.set_pair_enabled(a, b, false); });
        last_a = a;
        last_b = b;
    }
}

// ---- EVNT: what the next step is compared with -----------------------------------------------------

void Snapshot::save_pairs(const vox_grid& grid, SnapshotWriter& out) {
    const Array<vox_pair>& pairs = grid.pairs_.pairs_[grid.pairs_.current_];
    out.begin_chunk("EVNT");
    out.u64(static_cast<std::uint64_t>(std::ranges::count_if(pairs, touches)));
    out.u64(0);
    for (const vox_pair& pair : pairs) {
        if (!touches(pair)) continue;
        out.u32(pair.body_a);
        out.u32(pair.body_b);
        out.u64(pair.user_data_a);
        out.u64(pair.user_data_b);
    }
    out.end_chunk();
}

// The id of a mesh that is in the grid or was: pairs of meshes that were removed end in the next step.
vox_body Snapshot::mesh_that_was(SnapshotChunk& in, const vox_grid& grid) {
    const vox_body id = in.u32();
    const std::uint32_t slot = slot_of(id), generation = generation_of(id);
    if (generation == 0 || slot >= grid.meshes_.slots_.size() ||
        generation > grid.meshes_.slots_[slot].generation)
        in.refuse(format("body %" PRIu32 " was never in the grid", id));
    return id;
}

void Snapshot::load_pairs(SnapshotChunk& in, Loading& to) {
    Array<vox_pair>& pairs = to.grid.pairs_.pairs_[to.grid.pairs_.current_];
    const std::uint64_t count = in.u64();
    if (const std::uint64_t reserved = in.u64(); reserved != 0)
        in.refuse(format("a reserved number is %" PRIu64 ", expected 0", reserved));
    in.expect(count, 24, "pairs");
    pairs.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) {
        vox_pair pair{};
        pair.body_a = mesh_that_was(in, to.grid);
        pair.body_b = mesh_that_was(in, to.grid);
        pair.user_data_a = in.u64();
        pair.user_data_b = in.u64();
        pair.state = VOX_PAIR_PERSISTED;
        if (pair.body_a > pair.body_b || (i > 0 && std::tie(pairs.back().body_a, pairs.back().body_b) >=
                                                       std::tie(pair.body_a, pair.body_b)))
            in.refuse(format("pair %" PRIu64 " (%" PRIu32 ", %" PRIu32 ") is out of order", i, pair.body_a,
                             pair.body_b));
        pairs.push_back(pair);
    }
    in.end();
}

// ---- the whole ------------------------------------------------------------------------------------

std::uint64_t Snapshot::save(const vox_grid& grid, std::byte* bytes) noexcept {
    SnapshotWriter out(bytes);
    for (const Part& part : parts) part.save(grid, out);
    return out.finish();
}

vox_grid_desc Snapshot::settings(SnapshotReader in, const vox_grid_desc& machine,
                                 vox_reference_desc& reference) {
    SnapshotChunk chunk;
    if (!in.next(chunk)) throw Error(VOX_ERROR_FORMAT, "snapshot: it has no chunk");
    if (!chunk.is("GRID")) chunk.refuse("expected chunk GRID first");
    return read_settings(chunk, machine, reference, nullptr);
}

void Snapshot::load(SnapshotReader in, vox_grid& grid) {
    Loading to{.grid = grid,
               .awaited = Array<vox_body>(&grid.memory_),
               .free_slots = Array<std::uint32_t>(&grid.memory_)};
    bool seen[std::size(parts)] = {};
    std::size_t last = 0; // the part that came last
    for (SnapshotChunk chunk; in.next(chunk);) {
        const auto part =
            std::find_if(std::begin(parts), std::end(parts), [&](const Part& p) { return chunk.is(p.name); });
        if (part == std::end(parts)) {
            if (chunk.may_be_skipped()) continue;
            throw Error(VOX_ERROR_UNSUPPORTED,
                        format("snapshot: chunk %s is unknown, a later version of the library wrote it",
                               chunk.name().c_str()));
        }
        const auto index = static_cast<std::size_t>(part - std::begin(parts));
        if (index < last) chunk.refuse(format("it comes after chunk %s", parts[last].name));
        if (seen[index] && !part->repeats) chunk.refuse("it comes a second time");
        for (std::size_t before = 0; before < index; ++before)
            if (parts[before].required && !seen[before])
                chunk.refuse(format("expected chunk %s before it", parts[before].name));
        seen[index] = true;
        last = index;
        part->load(chunk, to);
    }
    for (std::size_t part = 0; part < std::size(parts); ++part)
        if (parts[part].required && !seen[part])
            throw Error(VOX_ERROR_FORMAT, format("snapshot: it has no chunk %s", parts[part].name));
    if (to.next != to.awaited.size())
        throw Error(VOX_ERROR_FORMAT,
                    format("snapshot: it has %zu of %zu bodies, body %" PRIu32 " is missing", to.next,
                           to.awaited.size(), to.awaited[to.next]));
    grid.meshes_.free_slots_.assign(to.free_slots.begin(), to.free_slots.end()); // within the capacity
}

} // namespace vox
