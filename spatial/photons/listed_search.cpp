#include "spatial/photons/listed_search.h"

#include <utility>

#include "spatial/listed_columns.h"
#include "spatial/photons/found_walk.h"

namespace regather::spatial {
namespace {

template <class Index>
class ListedSearch : public PhotonSearch {
public:
    ListedSearch(Index index, bool tells_found, const std::string& text)
        : index_(std::move(index)), structure_(index_.share_structure()), tells_found_(tells_found) {
        if (tells_found) structure_ = std::make_shared<WithFound>(structure_, text);
    }
    std::shared_ptr<const Structure> structure() const override { return structure_; }
    Recording record(std::span<const Vec3> points, std::uint32_t k, float radius,
                     bool tells_candidates) const override {
        return record_walks(index_, points, k, radius, {tells_found_, tells_candidates});
    }
    std::span<const std::uint32_t> photon_at() const override { return index_.parts().photon_at(); }
    void store(trace::TraceWriter& writer) const override {
        store_elements(writer, *index_.share_structure());
        writer.column("tree_leaf_begin").append(index_.parts().begin());
        writer.column("tree_photon").append(photon_at());
    }

protected:
    const Index& index() const { return index_; }

private:
    Index index_;
    std::shared_ptr<const Structure> structure_;
    bool tells_found_;
};

class BlockSearch final : public ListedSearch<BlockHashing> {
public:
    BlockSearch(std::span<const Photon> heap, const BlockHashing::Config& config, bool tells_found,
                const std::string& text)
        : ListedSearch(BlockHashing(heap, config, text), tells_found, text), heap_(heap) {}
    std::optional<Recall> recall(std::span<const Vec3> points, std::uint32_t k, float radius) const override {
        return recall_of(index(), heap_, points, k, radius);
    }

private:
    std::span<const Photon> heap_;
};

}  // namespace

template <class Index>
std::unique_ptr<PhotonSearch> build_listed(std::span<const Photon> heap, const trace::Parameters& given,
                                           std::string text, std::uint32_t, float) {
    const char* const bucket = given.knows("cell") ? "cell" : "leaf";
    return std::make_unique<ListedSearch<Index>>(Index(heap, given.count(bucket), text),
                                                 given.count("found") == 1, text);
}

template <>
std::unique_ptr<PhotonSearch> build_listed<BlockHashing>(std::span<const Photon> heap,
                                                         const trace::Parameters& given, std::string text,
                                                         std::uint32_t, float) {
    const BlockHashing::Config config{
        .tables = given.count("tables"), .block = given.count("block"), .blocks = given.count("blocks")};
    const std::string name = std::move(text);
    return std::make_unique<BlockSearch>(heap, config, given.count("found") == 1, name);
}

template <class Index>
std::shared_ptr<const Structure> open_listed(trace::TraceReader& trace) {
    Listed::Elements elements = open_elements(trace);
    elements.node_bytes = Index::node_bytes;
    return std::make_shared<Listed>(trace.info().structure, std::move(elements));
}

std::shared_ptr<const Structure> open_brought(trace::TraceReader& trace) {
    return std::make_shared<Listed>(trace.info().structure, open_elements(trace));
}

#define REGATHER_LISTED(Index)                                                                 \
    template std::unique_ptr<PhotonSearch> build_listed<Index>(                                \
        std::span<const Photon>, const trace::Parameters&, std::string, std::uint32_t, float); \
    template std::shared_ptr<const Structure> open_listed<Index>(trace::TraceReader&);
REGATHER_LISTED(PhotonGrid)
REGATHER_LISTED(HashedGrid)
REGATHER_LISTED(PhotonOctree)
REGATHER_LISTED(PhotonBvh)
#undef REGATHER_LISTED
template std::shared_ptr<const Structure> open_listed<BlockHashing>(trace::TraceReader&);

}  // namespace regather::spatial
