#include "experiment/treelet_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "replay/buffer_stream.h"
#include "replay/line_stream.h"
#include "replay/system_stream.h"
#include "trace/error.h"
#include "trace/size.h"
#include "trace/text.h"

namespace regather::experiment {
namespace {

constexpr std::uint64_t most_treelet_bytes = 1u << 30, progress_rays = 1 << 16;

std::uint64_t aligned(std::uint64_t bytes) {
    constexpr std::uint64_t multiple = replay::BufferStream::alignment;
    return (bytes + multiple - 1) / multiple * multiple;
}

/// Tells `progress` now and then.
replay::QueriesDone now_and_then(const std::function<void(std::uint64_t)>& progress) {
    return [&progress](std::uint64_t made) {
        if (progress && made % progress_rays == 0) progress(made);
    };
}

}  // namespace

std::vector<replay::TreeletConfig> treelet_configs(std::span<const std::string> sizes,
                                                   std::span<const std::uint32_t> rays) {
    std::vector<replay::TreeletConfig> configs;
    std::set<std::pair<std::uint64_t, std::uint32_t>> seen;
    for (const std::string& size : sizes) {
        const std::uint64_t bytes = trace::parse_size(size);
        if (bytes < 1 || bytes > most_treelet_bytes)
            throw trace::UsageError(fmt::format("--treelets: found {}, expected 1 to {} bytes",
                                                trace::shown(size), most_treelet_bytes));
        for (const std::uint32_t most : rays) {
            if (!seen.emplace(bytes, most).second)
                throw trace::UsageError(
                    fmt::format("--treelets {} --queue {}: found twice, expected each once", bytes, most));
            configs.push_back({static_cast<std::uint32_t>(bytes), most});
        }
    }
    return configs;
}

reorder::OrderingSpec spec_of(const TreeletFeed& feed) {
    constexpr std::string_view behind = "+treelets";
    reorder::OrderingSpec spec = feed.parsed.spec;
    const std::string given = spec.text.starts_with(spec.name) ? spec.text.substr(spec.name.size()) : "";
    spec.name += behind;
    spec.text = fmt::format("{}{}{}treelet={},rays={}", spec.name, given, given.empty() ? ":" : ",",
                            feed.config.treelet_bytes, feed.config.rays);
    return spec;
}

std::vector<results::Row> treelet_rows(const Measurement& measurement, const TreeletFeed& feed,
                                       std::span<const cachesim::CacheConfig> caches,
                                       const std::function<void(std::uint64_t)>& progress) {
    using replay::TreeletUse;
    const auto start = std::chrono::steady_clock::now();
    const reorder::BufferUse use = measurement.buffer_use(*feed.parsed.ordering, feed.ordered);
    const std::span<const std::uint32_t> permutation = feed.ordered.permutation;
    const replay::QueriesDone tell = now_and_then(progress);
    replay::CacheStream alone(caches), with_queues(caches);
    std::uint64_t raw_bytes = 0;
    const auto sink = [&](const cachesim::ByteAccess& access, trace::Region region, TreeletUse for_what) {
        with_queues.append(access, region);
        if (for_what == TreeletUse::queue) return;
        alone.append(access, region);
        raw_bytes += access.bytes;
    };
    // The order's own buffers lie behind those of the queues.
    replay::BufferStream buffers(use, permutation);
    const std::uint64_t buffers_at = aligned(replay::treelet_memory(replay::hierarchy_of(measurement.walks()),
                                                                    measurement.layout(), feed.config.rays)
                                                 .end);
    const replay::BufferStream::Sink into_cache = [&](std::span<const cachesim::ByteAccess> accesses) {
        for (const cachesim::ByteAccess& access : accesses)
            with_queues.append({buffers_at + access.address, access.bytes, access.kind},
                               trace::Region::reorder_buffer);
    };
    const replay::TreeletRun run =
        replay::run_treelets(measurement.walks(), measurement.layout(), permutation, feed.config,
                             measurement.onchip_bytes(), sink, [&](std::uint64_t made) {
                                 tell(made);
                                 buffers.before(made, into_cache);
                             });
    buffers.finish(into_cache);
    alone.finish();
    with_queues.finish();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const reorder::OrderingSpec spec = spec_of(feed);
    const reorder::Cost& cost = feed.ordered.cost;
    std::vector<results::Row> rows;
    for (std::size_t c = 0; c < caches.size(); ++c) {
        results::Row row = measurement.row(feed.parsed, feed.ordered, caches[c]);
        row.ordering = spec.name;
        row.parameters = spec.text;
        cachesim::CacheStats sum;
        for (std::size_t r = 0; r < trace::region_count; ++r) {
            const cachesim::CacheStats stats = alone.stats(c, static_cast<trace::Region>(r));
            sum.accesses += stats.accesses;
            sum.misses += stats.misses;
            sum.writebacks += stats.writebacks;
        }
        row.accesses = sum.accesses;
        row.raw_bytes = raw_bytes;
        row.misses = sum.misses;
        row.writebacks = sum.writebacks;
        row.traffic_bytes = alone.traffic_bytes(c);
        if (use.known || cost.reorder_bytes == 0)
            row.buffer_traffic_bytes = with_queues.traffic_bytes(c) - alone.traffic_bytes(c);
        row.moved_records = cost.moved_records + run.pushes;
        row.buffered_bytes = cost.buffered_bytes + run.state_bytes;
        row.reorder_bytes = cost.reorder_bytes + run.queue_bytes();
        row.replay_seconds = seconds;
        rows.push_back(std::move(row));
    }
    return rows;
}

void through_treelets(const Measurement& measurement, const TreeletFeed& feed,
                      std::span<cachesim::Hierarchy> systems,
                      const std::function<void(std::uint64_t)>& progress) {
    replay::SystemStream stream(systems);
    replay::run_treelets(
        measurement.walks(), measurement.layout(), feed.ordered.permutation, feed.config,
        measurement.onchip_bytes(),
        [&](const cachesim::ByteAccess& access, trace::Region region, replay::TreeletUse) {
            stream.append(access, region);
        },
        now_and_then(progress));
    stream.finish();
}

}  // namespace regather::experiment
