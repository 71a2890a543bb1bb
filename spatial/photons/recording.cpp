#include "spatial/photons/recording.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <concepts>
#include <type_traits>

#include "spatial/list_walk.h"
#include "spatial/photons/candidate_bits.h"
#include "spatial/photons/found_walk.h"
#include "spatial/photons/nearest.h"
#include "spatial/photons/nearest_facing.h"
#include "spatial/walk.h"

namespace regather::spatial {
namespace {

template <class Recorder, class Tree>
Recording recorded(const Tree& tree, std::span<const Vec3> points, std::uint32_t k, float radius) {
    constexpr bool tells_found = requires(Recorder recorder, const NearestSet& found) {
        recorder.finish(found);
    };
    constexpr bool tells_candidates = requires(Recorder recorder) {
        recorder.finish_candidates();
    };
    constexpr std::size_t chunk_points = 4096;
    struct Chunk {
        std::vector<std::uint8_t> walks, candidates;
        std::uint64_t found = 0, visited = 0;
    };
    Recording all;
    all.walk_bytes.resize(points.size());
    if (tells_candidates) all.candidate_bytes.resize(points.size());
    std::vector<Chunk> chunks((points.size() + chunk_points - 1) / chunk_points);
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        NearestSet found(std::min(k, tree.size()), radius);
        Recorder recorder = [&] {
            if constexpr (tells_found)
                return Recorder(tree.size());
            else
                return Recorder();
        }();
        const std::size_t end = std::min(points.size(), (c + 1) * chunk_points);
        for (std::size_t i = c * chunk_points; i < end; ++i) {
            nearest(tree, points[i], found, recorder);
            if constexpr (tells_found)
                all.walk_bytes[i] = recorder.finish(found);
            else
                all.walk_bytes[i] = recorder.finish();
            if constexpr (tells_candidates) all.candidate_bytes[i] = recorder.finish_candidates();
            chunks[c].found += found.size();
        }
        chunks[c].walks.assign(recorder.bytes().begin(), recorder.bytes().end());
        if constexpr (tells_candidates)
            chunks[c].candidates.assign(recorder.candidates().begin(), recorder.candidates().end());
        chunks[c].visited = recorder.visited_nodes();
    });
    for (const Chunk& chunk : chunks) {
        all.walks.insert(all.walks.end(), chunk.walks.begin(), chunk.walks.end());
        all.candidates.insert(all.candidates.end(), chunk.candidates.begin(), chunk.candidates.end());
        all.found_photons += chunk.found;
        all.visited_nodes += chunk.visited + (tells_found ? chunk.found : 0);
    }
    return all;
}

/// What listens where nobody asks which photons were found: decisions give a kd-tree's visits back, those of
/// all else are listed.
template <class Tree>
using RecorderOf = std::conditional_t<std::same_as<Tree, PhotonKd> || std::same_as<Tree, BucketKd>,
                                      WalkRecorder, ListWalkRecorder>;

constexpr std::size_t facing_chunk = 4096;

}  // namespace

Recording record_facing(const PhotonKd& tree, std::span<const Vec3> points, std::span<const Vec3> normals,
                        float radius) {
    Recording all;
    all.walk_bytes.resize(points.size());
    std::vector<WalkRecorder> chunks((points.size() + facing_chunk - 1) / facing_chunk);
    std::vector<std::uint64_t> found(chunks.size());
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        NearestFacing facing(tree.nodes(), radius);
        const std::size_t end = std::min(points.size(), (c + 1) * facing_chunk);
        for (std::size_t i = c * facing_chunk; i < end; ++i) {
            facing.look_for(normals[i]);
            nearest(tree, points[i], facing, chunks[c]);
            all.walk_bytes[i] = chunks[c].finish();
            found[c] += facing.found() ? 1 : 0;
        }
    });
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        all.walks.insert(all.walks.end(), chunks[c].bytes().begin(), chunks[c].bytes().end());
        all.visited_nodes += chunks[c].visited_nodes();
        all.found_photons += found[c];
    }
    return all;
}

template <class Tree>
Recording record_walks(const Tree& tree, std::span<const Vec3> points, std::uint32_t k, float radius,
                       Telling telling) {
    using Walk = RecorderOf<Tree>;
    using WalkWithFound = BasicFoundRecorder<Walk>;
    if (telling.candidates)
        return telling.found ? recorded<CandidateRecorder<WalkWithFound>>(tree, points, k, radius)
                             : recorded<CandidateRecorder<Walk>>(tree, points, k, radius);
    return telling.found ? recorded<WalkWithFound>(tree, points, k, radius)
                         : recorded<Walk>(tree, points, k, radius);
}
template Recording record_walks(const PhotonKd&, std::span<const Vec3>, std::uint32_t, float, Telling);
template Recording record_walks(const BucketKd&, std::span<const Vec3>, std::uint32_t, float, Telling);
template Recording record_walks(const PhotonGrid&, std::span<const Vec3>, std::uint32_t, float, Telling);
template Recording record_walks(const HashedGrid&, std::span<const Vec3>, std::uint32_t, float, Telling);
template Recording record_walks(const PhotonOctree&, std::span<const Vec3>, std::uint32_t, float, Telling);
template Recording record_walks(const PhotonBvh&, std::span<const Vec3>, std::uint32_t, float, Telling);
template Recording record_walks(const BlockHashing&, std::span<const Vec3>, std::uint32_t, float, Telling);

}  // namespace regather::spatial
