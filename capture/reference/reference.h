// capture/reference/reference.h -- a path-traced image that can stop, go on and be measured against:
// docs/reference.md. On disk it is a folder: the moments of every pixel as a column, and reference.json,
// which names it and is written last, by an atomic rename. A process killed at any moment leaves the state of
// the last save readable.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "capture/images/image.h"
#include "capture/reference/path_tracer.h"

namespace regather::capture {

/// What a reference is a picture of: only samples with the same key may be added.
struct ReferenceKey {
    std::string scene;                    ///< For people.
    std::string scene_checksum;           ///< capture::checksum, of the scene with the frame's camera.
    std::uint32_t width = 0, height = 0;  ///< [pixels]
    std::uint64_t seed = 1;
};

struct Reference {
    ReferenceKey key;
    std::uint32_t samples = 0;  ///< A pixel.
    double seconds = 0;         ///< Of wall clock, that the samples took.
    PathCounts counts;
    std::vector<Moments> pixels;  ///< In row order.

    explicit Reference(ReferenceKey what);

    /// `count` samples more a pixel, by a tracer of the same scene, size and seed: the same bits however the
    /// samples are cut into calls. Throws trace::UsageError beyond 2^32 - 1 samples.
    void add(const PathTracer& tracer, std::uint32_t count,
             const std::function<void(std::uint64_t)>& finished = {});

    Image mean() const;
    Image variance()
        const;  ///< Of the mean, by pixel and channel [(W / (m^2 sr))^2]; 0 for fewer than two samples.
    double mean_variance()
        const;  ///< Its mean over pixels and channels: the squared error that the reference itself has.
    double median_variance()
        const;  ///< Of the pixels' (mean over their channels): edges of lights do not weigh in.
    double mean_radiance() const;  ///< Over pixels and channels.
};

bool holds_reference(const std::filesystem::path& folder);

/// Throws trace::DataError (file, field, found, expected) when there is none, or a damaged one.
Reference load_reference(const std::filesystem::path& folder);

/// The folder's reference, to be gone on with; one without samples when the folder holds none.
/// trace::UsageError when it holds one of another scene, size or seed.
Reference resume_reference(const std::filesystem::path& folder, const ReferenceKey& key);

/// Creates the folder if needed. At least one sample.
void save(const Reference& reference, const std::filesystem::path& folder);

/// reference.exr (mean), variance.exr (of the mean) and reference.png.
void write_images(const Reference& reference, const std::filesystem::path& folder);

}  // namespace regather::capture
