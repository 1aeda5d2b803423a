#include "dist/rounds.hpp"
#include "base/llu.hpp"
#include "dist/packed_box.hpp"

#include <algorithm>
#include <tuple>

namespace vox::dist {

Rounds::Rounds(vox_dist_scene& scene, SearchGrid& grid, bool points)
    : tet_hits(&scene.memory_), vertex_hits(&scene.memory_), scene_(scene), grid_(grid), points_(points),
      memory_(&scene.memory_), writers_(memory_), remote_parts_(memory_), remote_begins_(memory_),
      boxes_(memory_), box_begins_(memory_), split_bodies_(memory_), reported_parts_(memory_),
      reported_begins_(memory_), sent_(memory_), sent_begins_(memory_), foreign_groups_(memory_),
      foreign_vertices_(memory_), foreign_positions_(memory_), copied_vertices_(memory_) {}

// After a failure, here or at a neighbour, the rounds go on with messages that say so, and read none.
void Rounds::run(std::span<const VertexSource> sources, Failure& failure) {
    const auto round = [&](auto&& write, std::uint64_t& bytes) {
        failure.guard(write);
        scene_.exchange(&bytes, failure);
    };
    round([&] { write_boxes(); }, scene_.counters_.box_bytes);
    round([&] { read_boxes(), choose_vertices(sources); }, scene_.counters_.vertex_bytes);
    round(
        [&] {
            take_vertices();
            if (points_) take_points_of_this_rank(sources);
            step_grid();
            collect_here();
            write_hits();
        },
        scene_.counters_.hit_bytes);
    failure.guard([&] { read_hits(sources); });
}

// ---- boxes ----------------------------------------------------------------------------------------

void Rounds::write_boxes() {
    Array<Box3f> near_boxes(memory_);
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) writers_.emplace_back(memory_);
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        const Overview& other = scene_.overviews_[scene_.ranks_[i]];
        const Box3f& vertices = other.vertices;
        for (std::uint32_t p = 0; p < scene_.parts_.size(); ++p) {
            const Part& part = *scene_.parts_[p];
            if (!other.collides_with(part.body) || !overlap(part.tet_box, vertices)) continue;
            near_boxes.clear();
            Box3f frame = empty_box3f();
            for (const Box3f& box : part.tet_clusters.boxes)
                if (overlap(box, vertices)) {
                    near_boxes.push_back(box);
                    extend(frame, box);
                }
            if (near_boxes.empty()) continue;
            const bool has_filter = part.filter != Filter{};
            const auto count = static_cast<std::uint32_t>(near_boxes.size());
            Writer& writer = writers_[i];
            writer.add(PartBoxes{part.body, p, has_filter ? count | filter_bit : count});
            if (has_filter) writer.add(part.filter);
            writer.add(frame);
            const BoxPacking packing(frame);
            if (count > 1)
                for (const Box3f& box : near_boxes) writer.add(packing.pack(box));
        }
        scene_.out_[i] = writers_[i].bytes();
    }
}

void Rounds::read_boxes() {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        remote_begins_.push_back(remote_parts_.size());
        for (Reader reader(scene_.in_[i]); reader.more();) {
            const auto header = reader.take<PartBoxes>();
            const Filter filter = header.boxes & filter_bit ? reader.take<Filter>() : Filter{};
            remote_parts_.push_back({header.body, filter, header.part});
            box_begins_.push_back(boxes_.size());
            const auto box = reader.take<Box3f>();
            const BoxPacking packing(box);
            const std::uint32_t count = header.boxes & ~filter_bit;
            if (count == 1)
                boxes_.push_back(box);
            else
                for (std::uint32_t b = 0; b < count; ++b)
                    boxes_.push_back(packing.unpack(reader.take<std::uint64_t>()));
        }
    }
    remote_begins_.push_back(remote_parts_.size());
    box_begins_.push_back(boxes_.size());
    if (!points_) find_split_bodies();
}

// Every rank whose tetrahedra may contain a vertex of this rank has sent boxes.
void Rounds::find_split_bodies() {
    Array<std::uint64_t> bodies(memory_);
    for (const RemotePart& part : remote_parts_) bodies.push_back(part.body);
    for (const Part* part : scene_.parts_)
        if (!is_empty(part->tet_box)) bodies.push_back(part->body);
    std::ranges::sort(bodies);
    for (std::size_t i = 1; i < bodies.size(); ++i)
        if (bodies[i - 1] == bodies[i] && (split_bodies_.empty() || split_bodies_.back() != bodies[i]))
            split_bodies_.push_back(bodies[i]);
}

// ---- vertices -------------------------------------------------------------------------------------

void Rounds::choose_vertices(std::span<const VertexSource> sources) {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        sent_begins_.push_back(sent_.size());
        writers_[i].clear();
        if (remote_begins_[i] != remote_begins_[i + 1]) {
            if (!points_) report_split_bodies(i);
            send_vertices_to(i, sources);
            if (sent_begins_[i] == sent_.size()) writers_[i].clear();
        }
        scene_.out_[i] = writers_[i].bytes();
    }
    sent_begins_.push_back(sent_.size());
    scene_.counters_.vertices_sent += sent_.size();
}

// A rank that has all tetrahedra of a body knows which hits are contacts, and needs no verdict.
void Rounds::report_split_bodies(std::uint32_t neighbour) {
    std::uint64_t count = 0;
    const std::size_t at = writers_[neighbour].add(count);
    for (std::uint64_t r = remote_begins_[neighbour]; r < remote_begins_[neighbour + 1]; ++r)
        if (std::binary_search(split_bodies_.begin(), split_bodies_.end(), remote_parts_[r].body)) {
            writers_[neighbour].add(remote_parts_[r].part);
            ++count;
        }
    writers_[neighbour].set(at, count);
}

void Rounds::send_vertices_to(std::uint32_t neighbour, std::span<const VertexSource> sources) {
    Array<Box3f> near_source(memory_), near_cluster(memory_);
    Writer& writer = writers_[neighbour];
    for (std::uint32_t s = 0; s < sources.size(); ++s) {
        const VertexSource& source = sources[s];
        near_source.clear();
        for (std::uint64_t r = remote_begins_[neighbour]; r < remote_begins_[neighbour + 1]; ++r) {
            const RemotePart& remote = remote_parts_[r];
            if (source.part && !collide(source.part->body, source.part->filter, remote.body, remote.filter))
                continue;
            for (std::uint64_t b = box_begins_[r]; b < box_begins_[r + 1]; ++b)
                if (overlap(boxes_[b], source.box)) near_source.push_back(boxes_[b]);
        }
        if (near_source.empty()) continue;
        VerticesHeader header{0, 0, source.positions.doubles, 0};
        if (source.part) {
            header.body = source.part->body;
            header.has_filter = source.part->filter != Filter{};
        }
        const std::size_t at = writer.add(header);
        if (header.has_filter) writer.add(source.part->filter);
        for (std::uint32_t c = 0; c < source.clusters->size(); ++c) {
            near_cluster.clear();
            for (const Box3f& box : near_source)
                if (overlap(box, source.clusters->boxes[c])) near_cluster.push_back(box);
            if (near_cluster.empty()) continue;
            for (const std::uint32_t v : source.clusters->of(c)) {
                const Vec3d p = source.positions.exact(v);
                if (std::ranges::none_of(near_cluster, [&](const Box3f& box) { return contains(box, p); }))
                    continue;
                const std::uint64_t id = source.part ? source.part->id_of(v) : v;
                if (header.doubles)
                    writer.add(VertexDoubles{id, p});
                else
                    writer.add(VertexFloats{id, nearest_floats(p)});
                sent_.push_back({s, v});
                ++header.count;
            }
        }
        if (header.count)
            writer.set(at, header);
        else
            writer.shrink(at);
    }
}

void Rounds::take_vertices() {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        std::uint32_t place = 0;
        reported_begins_.push_back(reported_parts_.size());
        Reader reader(scene_.in_[i]);
        if (!points_ && reader.more())
            for (auto count = reader.take<std::uint64_t>(); count > 0; --count)
                reported_parts_.push_back(reader.take<std::uint32_t>());
        while (reader.more()) {
            const auto header = reader.take<VerticesHeader>();
            const Filter filter = header.has_filter ? reader.take<Filter>() : Filter{};
            const Part* const copies = points_ ? nullptr : scene_.find_body(header.body);
            const auto group = static_cast<std::uint32_t>(foreign_groups_.size());
            foreign_groups_.push_back({header.body, filter, i});
            for (std::uint32_t n = 0; n < header.count; ++n, ++place) {
                VertexDoubles vertex{};
                if (header.doubles) {
                    vertex = reader.take<VertexDoubles>();
                } else {
                    const auto floats = reader.take<VertexFloats>();
                    vertex = {floats.id, floats.position};
                }
                const Vec3d& p = vertex.position;
                if (const auto copy = copies ? copies->find(vertex.id) : std::nullopt) {
                    const Vec3d q = copies->positions.exact(*copy);
                    if (p.x != q.x || p.y != q.y || p.z != q.z)
                        throw Error(
                            VOX_ERROR_INVALID_STATE,
                            format("vertex %llu of body %llu is at %.17g %.17g %.17g on rank %u, and its "
                                   "copy at %.17g %.17g %.17g on rank %u",
                                   llu(vertex.id), llu(header.body), p.x, p.y, p.z, scene_.ranks_[i], q.x,
                                   q.y, q.z, scene_.transport_.rank()));
                    copied_vertices_.push_back({copies, *copy, i, place});
                } else {
                    foreign_vertices_.push_back({vertex.id, group, place});
                    foreign_positions_.push_back(p);
                }
            }
        }
        scene_.counters_.vertices_received += place;
    }
    reported_begins_.push_back(reported_parts_.size());
    scene_.counters_.vertices_here += copied_vertices_.size();
    std::ranges::sort(copied_vertices_, {}, &CopiedVertex::key);
}

} // namespace vox::dist
