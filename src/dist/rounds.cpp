#include "dist/rounds.hpp"
#include "dist/packed_box.hpp"

#include <algorithm>
#include <tuple>

namespace vox::dist {

Rounds::Rounds(vox_dist_scene& scene, Side& side, bool points)
    : outgoing(&scene.memory_), found(&scene.memory_), scene_(scene), side_(side), points_(points),
      memory_(&scene.memory_), writers_(memory_), remote_(memory_), remote_begin_(memory_), boxes_(memory_),
      boxes_begin_(memory_), split_(memory_), told_split_(memory_), told_split_begin_(memory_),
      sent_(memory_), sent_begin_(memory_), groups_(memory_), strangers_(memory_), xyz_(memory_),
      known_(memory_) {}

void Rounds::send_nothing() noexcept {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) scene_.out_[i] = {nullptr, 0};
}

// After a failure, here or at a neighbour, the rounds go on with messages that say so, and nothing is read.
void Rounds::run(std::span<const Source> sources, Failure& failure) {
    const auto round = [&](auto&& write, std::uint64_t& bytes) {
        send_nothing();
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
    Array<Box> near(memory_);
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) writers_.emplace_back(memory_);
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        const Overview& other = scene_.overviews_[scene_.ranks_[i]];
        const Box& vertices = other.vertices;
        for (std::uint32_t p = 0; p < scene_.parts_.size(); ++p) {
            const Part& part = *scene_.parts_[p];
            if (!other.collides_with(part.body) || !part.tet_box.meets(vertices)) continue;
            near.clear();
            Box frame;
            for (const Box& box : part.tet_clusters.boxes)
                if (box.meets(vertices)) {
                    near.push_back(box);
                    frame.add(box);
                }
            if (near.empty()) continue;
            const bool has_filter = part.filter != Filter{};
            const auto count = static_cast<std::uint32_t>(near.size());
            Writer& writer = writers_[i];
            writer.add(PartBoxes{part.body, p, has_filter ? count | filter_bit : count});
            if (has_filter) writer.add(part.filter);
            writer.add(frame);
            const Frame packing(frame);
            if (near.size() > 1)
                for (const Box& box : near) writer.add(packing.pack(box));
        }
        scene_.out_[i] = writers_[i].bytes();
    }
}

void Rounds::read_boxes() {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        remote_begin_.push_back(remote_.size());
        for (Reader reader(scene_.in_[i]); reader.more();) {
            const auto header = reader.take<PartBoxes>();
            const Filter filter = header.boxes & filter_bit ? reader.take<Filter>() : Filter{};
            remote_.push_back({header.body, filter, header.part});
            boxes_begin_.push_back(boxes_.size());
            const auto box = reader.take<Box>();
            const Frame packing(box);
            const std::uint32_t count = header.boxes & ~filter_bit;
            if (count == 1)
                boxes_.push_back(box);
            else
                for (std::uint32_t b = 0; b < count; ++b)
                    boxes_.push_back(packing.unpack(reader.take<std::uint64_t>()));
        }
    }
    remote_begin_.push_back(remote_.size());
    boxes_begin_.push_back(boxes_.size());
    if (!points_) find_split_bodies();
}

// All ranks whose tetrahedra can have a vertex of this rank inside have sent boxes.
void Rounds::find_split_bodies() {
    Array<std::uint64_t> bodies(memory_);
    for (const Remote& part : remote_) bodies.push_back(part.body);
    for (const Part* part : scene_.parts_)
        if (!part->tet_box.empty()) bodies.push_back(part->body);
    std::sort(bodies.begin(), bodies.end());
    for (std::size_t i = 1; i < bodies.size(); ++i)
        if (bodies[i - 1] == bodies[i] && (split_.empty() || split_.back() != bodies[i]))
            split_.push_back(bodies[i]);
}

// ---- vertices -------------------------------------------------------------------------------------

void Rounds::choose_vertices(std::span<const Source> sources) {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        sent_begin_.push_back(sent_.size());
        writers_[i].clear();
        if (remote_begin_[i] != remote_begin_[i + 1]) {
            if (!points_) tell_split_bodies(i);
            send_vertices_to(i, sources);
            if (sent_begin_[i] == sent_.size()) writers_[i].clear();
        }
        scene_.out_[i] = writers_[i].bytes();
    }
    sent_begin_.push_back(sent_.size());
    scene_.counters_.vertices_sent += sent_.size();
}

// Where a body is on one rank alone, that rank knows which hits of a vertex are contacts, and waits for no
// verdict.
void Rounds::tell_split_bodies(std::uint32_t neighbour) {
    std::uint64_t count = 0;
    const std::size_t at = writers_[neighbour].add(count);
    for (std::uint64_t r = remote_begin_[neighbour]; r < remote_begin_[neighbour + 1]; ++r)
        if (std::binary_search(split_.begin(), split_.end(), remote_[r].body)) {
            writers_[neighbour].add(remote_[r].part);
            ++count;
        }
    writers_[neighbour].set(at, count);
}

void Rounds::send_vertices_to(std::uint32_t neighbour, std::span<const Source> sources) {
    Array<Box> near_source(memory_), near_cluster(memory_);
    Writer& writer = writers_[neighbour];
    for (std::uint32_t s = 0; s < sources.size(); ++s) {
        const Source& source = sources[s];
        near_source.clear();
        for (std::uint64_t r = remote_begin_[neighbour]; r < remote_begin_[neighbour + 1]; ++r) {
            const Remote& remote = remote_[r];
            if (source.part && !collide(source.part->body, source.part->filter, remote.body, remote.filter))
                continue;
            for (std::uint64_t b = boxes_begin_[r]; b < boxes_begin_[r + 1]; ++b)
                if (boxes_[b].meets(source.box)) near_source.push_back(boxes_[b]);
        }
        if (near_source.empty()) continue;
        Vertices header{0, 0, source.positions.doubles, 0};
        if (source.part) {
            header.body = source.part->body;
            header.has_filter = source.part->filter != Filter{};
        }
        const std::size_t at = writer.add(header);
        if (header.has_filter) writer.add(source.part->filter);
        for (std::uint32_t c = 0; c < source.clusters->size(); ++c) {
            near_cluster.clear();
            for (const Box& box : near_source)
                if (box.meets(source.clusters->boxes[c])) near_cluster.push_back(box);
            if (near_cluster.empty()) continue;
            for (const std::uint32_t v : source.clusters->of(c)) {
                double position[3];
                get(source.positions, v, position);
                if (std::none_of(near_cluster.begin(), near_cluster.end(),
                                 [&](const Box& box) { return box.holds(position); }))
                    continue;
                const std::uint64_t id = source.part ? source.part->id_of(v) : v;
                if (header.doubles)
                    writer.add(VertexDoubles{id, {position[0], position[1], position[2]}});
                else
                    writer.add(VertexFloats{id,
                                            {static_cast<float>(position[0]), static_cast<float>(position[1]),
                                             static_cast<float>(position[2])}});
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
        told_split_begin_.push_back(told_split_.size());
        Reader reader(scene_.in_[i]);
        if (!points_ && reader.more())
            for (auto count = reader.take<std::uint64_t>(); count > 0; --count)
                told_split_.push_back(reader.take<std::uint32_t>());
        while (reader.more()) {
            const auto header = reader.take<Vertices>();
            const Filter filter = header.has_filter ? reader.take<Filter>() : Filter{};
            const Part* const copies = points_ ? nullptr : scene_.find_body(header.body);
            const auto group = static_cast<std::uint32_t>(groups_.size());
            groups_.push_back({header.body, filter, i});
            for (std::uint32_t n = 0; n < header.count; ++n, ++place) {
                VertexDoubles vertex{};
                if (header.doubles) {
                    vertex = reader.take<VertexDoubles>();
                } else {
                    const auto floats = reader.take<VertexFloats>();
                    vertex = {floats.id, {floats.position[0], floats.position[1], floats.position[2]}};
                }
                if (const auto here = copies ? copies->find(vertex.id) : std::nullopt) {
                    double position[3];
                    get(copies->positions, *here, position);
                    if (!std::equal(position, position + 3, vertex.position))
                        throw Error(
                            VOX_ERROR_INVALID_STATE,
                            format("vertex %llu of body %llu is at %.17g %.17g %.17g on rank %u, and its "
                                   "copy at %.17g %.17g %.17g on rank %u",
                                   static_cast<unsigned long long>(vertex.id),
                                   static_cast<unsigned long long>(header.body), vertex.position[0],
                                   vertex.position[1], vertex.position[2], scene_.ranks_[i], position[0],
                                   position[1], position[2], scene_.transport_.rank()));
                    known_.push_back({copies, *here, i, place});
                } else {
                    strangers_.push_back({vertex.id, group, place});
                    xyz_.insert(xyz_.end(), vertex.position, vertex.position + 3);
                }
            }
        }
        scene_.counters_.vertices_received += place;
    }
    told_split_begin_.push_back(told_split_.size());
    scene_.counters_.vertices_here += known_.size();
    std::sort(known_.begin(), known_.end(), [](const Known& a, const Known& b) {
        return std::tuple(a.part->body, a.vertex) < std::tuple(b.part->body, b.vertex);
    });
}

} // namespace vox::dist
