#include "replay/buffered.h"

#include "replay/buffer_stream.h"
#include "replay/line_stream.h"
#include "replay/walk_run.h"

namespace regather::replay {

std::vector<BufferedTraffic> replay_with_buffers(const WalkStore& walks, const Layout& layout,
                                                 std::span<const std::uint32_t> permutation,
                                                 const reorder::BufferUse& use,
                                                 std::span<const cachesim::CacheConfig> caches,
                                                 const QueriesDone& progress) {
    CacheStream all(caches);
    BufferStream buffers(use, permutation);
    const BufferStream::Sink into_streams = [&](std::span<const cachesim::ByteAccess> accesses) {
        for (LineStream& stream : all.streams()) {
            const std::uint64_t base = buffer_base(layout, stream.line_bytes());
            for (const cachesim::ByteAccess& access : accesses)
                stream.append({base + access.address, access.bytes, access.kind},
                              trace::Region::reorder_buffer);
        }
    };
    std::uint64_t r = 0;
    run_walks(walks, permutation, progress, [&](std::span<const std::uint32_t> elements) {
        buffers.before(r++, into_streams);
        for (LineStream& stream : all.streams())
            layout.for_each(elements, [&](std::uint32_t, std::uint64_t address, std::uint32_t bytes) {
                stream.append({address, bytes, cachesim::Access::read}, trace::Region::photons);
            });
    });
    buffers.finish(into_streams);
    all.finish();

    std::vector<BufferedTraffic> result;
    for (std::size_t i = 0; i < caches.size(); ++i) {
        BufferedTraffic traffic{caches[i], all.stats(i, trace::Region::photons),
                                all.stats(i, trace::Region::reorder_buffer), 0, 0};
        const std::uint64_t line = caches[i].line_bytes;
        traffic.photon_bytes = (traffic.photons.misses + traffic.photons.writebacks) * line;
        traffic.buffer_bytes = (traffic.buffers.misses + traffic.buffers.writebacks) * line;
        result.push_back(traffic);
    }
    return result;
}

}  // namespace regather::replay
