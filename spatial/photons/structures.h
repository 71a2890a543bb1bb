// spatial/photons/structures.h -- the structures that photons are searched in, in one table, and how a spec
// names one of them: "left-balanced-kd", "median-kd:leaf=16". A trace says by such a spec what its walks were
// taken in.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "spatial/photons/recall.h"
#include "spatial/photons/recording.h"
#include "spatial/structure.h"
#include "trace/folder.h"
#include "trace/parameters.h"

namespace regather::spatial {

/// A structure that was built, with its geometry.
class PhotonSearch {
public:
    virtual ~PhotonSearch() = default;
    virtual std::shared_ptr<const Structure> structure() const = 0;
    /// As record_walks(); the walks tell which photons were found where the structure's do.
    virtual Recording record(std::span<const Vec3> points, std::uint32_t k, float radius,
                             bool tells_candidates) const = 0;
    /// Of the same searches, where they are not exact.
    virtual std::optional<Recall> recall(std::span<const Vec3>, std::uint32_t, float) const {
        return std::nullopt;
    }
    /// By place in the leaves, which photon lies there; empty where photons lie in their own order.
    virtual std::span<const std::uint32_t> photon_at() const = 0;
    /// Writes the columns that open_structure() reads beside `photon`.
    virtual void store(trace::TraceWriter& writer) const = 0;
};

struct StructureEntry {
    std::string_view name, summary;
    std::uint32_t version;  ///< Rises when walks of the same photons and queries change.
    std::span<const trace::Parameter> parameters;
    /// Null where walks are not recorded but brought.
    std::unique_ptr<PhotonSearch> (*build)(std::span<const Photon> heap, const trace::Parameters& given,
                                           std::string text, std::uint32_t k, float radius);
    std::shared_ptr<const Structure> (*open)(trace::TraceReader& trace);
    bool is_exact = true;  ///< Else PhotonSearch::recall() says what its searches find.
};

/// Its elements and walks are somebody else's.
inline constexpr std::string_view brought_structure = "visits";

/// The one table of structures.
std::span<const StructureEntry> structures();

/// What a spec asked for.
struct StructureSpec {
    const StructureEntry* entry;
    trace::Parameters parameters;
    std::string text;  ///< All parameters, defaults too; a spec again.
};
/// Throws trace::UsageError for an unknown name or parameter (with the nearest and all known ones) or a value
/// out of range.
StructureSpec parse_structure(std::string_view spec);

/// Built over `heap`, photons in the order of left_balanced(); outlived by them. `k` and `radius` are those
/// of the searches to come, which a rule of splitting may look at. Throws as BucketKd, and trace::UsageError
/// for a structure whose walks are brought.
std::unique_ptr<PhotonSearch> build(const StructureSpec& spec, std::span<const Photon> heap, std::uint32_t k,
                                    float radius);

/// What the walks of a trace were taken in, of rays, too (spatial/rays/ray_structures.h); its reader outlives
/// it. Throws trace::DataError for a structure or a version that this binary does not know, and for columns
/// that are no tree over the trace's photons.
std::shared_ptr<const Structure> open_structure(trace::TraceReader& trace);

/// Of the photons, by record of the structure; empty for a trace without photons. Throws trace::DataError for
/// a record that is no photon.
std::vector<Vec3> record_positions(trace::TraceReader& trace);

}  // namespace regather::spatial
