#include "capture/reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "trace/digest.h"
#include "trace/error.h"
#include "trace/field.h"
#include "trace/file.h"
#include "trace/median.h"
#include "trace/npy.h"
#include "trace/text.h"

namespace regather::capture {
namespace {

namespace fs = std::filesystem;
using trace::Field, trace::Json, trace::Kind;

constexpr int schema_version = 1;
constexpr std::uint64_t most_state_bytes = 1 << 20;
constexpr std::uint32_t most_pixels = 32768;  // along an edge
const char* const state_name = "reference.json";

const trace::ColumnType& moments_type() {
    static const trace::ColumnType type{"'<f8'", "6", sizeof(Moments), "float64 x 6"};
    return type;
}

std::string moments_name(std::uint32_t samples) {
    return fmt::format("moments-{}.npy", samples);
}

constexpr std::string_view whole = "a whole number", text = "a text";
const Kind reference_kind{"reference",
                          {{"reference_version", true, "the version of the format"},
                           {"scene", true, text},
                           {"scene_checksum", true, text},
                           {"image_width", true, whole},
                           {"image_height", true, whole},
                           {"seed", true, whole},
                           {"samples", true, whole},
                           {"seconds", true, "a number of seconds"},
                           {"paths", true, whole},
                           {"rays", true, whole},
                           {"shadow_rays", true, whole},
                           {"cut_off_paths", true, whole},
                           {"nonfinite_paths", true, whole},
                           {"moments", true, text},
                           {"moments_checksum", true, text}}};

/// Of n samples that are not negative, the squared distances from their mean m add up to n (n - 1) m^2 at
/// most: all of the light is then in one of them. What no samples can have is damage, whatever the checksum
/// says.
void check(const Moments& pixel, std::uint64_t samples, const fs::path& file, std::size_t row) {
    constexpr double rounding = 1e-6;
    const double n = static_cast<double>(samples);
    for (std::size_t c = 0; c < 3; ++c) {
        const double mean = pixel.mean[c], squares = pixel.squares[c];
        const double most = n * (n - 1) * mean * mean * (1 + rounding);
        if (!std::isfinite(mean) || mean < 0 || !std::isfinite(squares) || squares < 0 || squares > most)
            throw trace::DataError(
                fmt::format("{}: row {}, channel {}: found a mean of {} and squares of {}, expected "
                            "those of {} samples that are not negative",
                            file.string(), row, c, mean, squares, samples));
    }
}

/// Only the newest, which reference.json names, is kept.
void remove_moments_but(const fs::path& folder, const std::string& kept) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("moments-") && name != kept) fs::remove(entry.path());
    }
}

Image image_of(const Reference& reference, double (*value)(const Moments&, std::size_t, std::uint64_t)) {
    Image image{reference.key.width, reference.key.height, {}};
    image.pixels.reserve(reference.pixels.size());
    for (const Moments& pixel : reference.pixels) {
        Vec3 colour;
        for (int c = 0; c < 3; ++c)
            colour[c] = static_cast<float>(value(pixel, static_cast<std::size_t>(c), reference.samples));
        image.pixels.push_back(colour);
    }
    return image;
}

}  // namespace

Reference::Reference(ReferenceKey what) : key(std::move(what)), pixels(std::size_t{key.width} * key.height) {}

void Reference::add(const PathTracer& tracer, std::uint32_t count,
                    const std::function<void(std::uint64_t)>& finished) {
    if (count > std::numeric_limits<std::uint32_t>::max() - samples)
        throw trace::UsageError(
            fmt::format("samples: found {} and {} more, expected fewer than 2^32", samples, count));
    const auto start = std::chrono::steady_clock::now();
    counts += tracer.add(pixels, samples, count, finished);
    samples += count;
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Image Reference::mean() const {
    return image_of(*this, [](const Moments& pixel, std::size_t c, std::uint64_t) { return pixel.mean[c]; });
}

Image Reference::variance() const {
    return image_of(
        *this, [](const Moments& pixel, std::size_t c, std::uint64_t n) { return pixel.variance(c, n); });
}

double Reference::mean_variance() const {
    double sum = 0;
    for (const Moments& pixel : pixels)
        for (std::size_t c = 0; c < 3; ++c) sum += pixel.variance(c, samples);
    return pixels.empty() ? 0 : sum / (3 * static_cast<double>(pixels.size()));
}

double Reference::median_variance() const {
    std::vector<double> all;
    for (const Moments& pixel : pixels)
        all.push_back((pixel.variance(0, samples) + pixel.variance(1, samples) + pixel.variance(2, samples)) /
                      3);
    return all.empty() ? 0 : trace::upper_median(std::move(all));
}

double Reference::mean_radiance() const {
    double sum = 0;
    for (const Moments& pixel : pixels)
        for (std::size_t c = 0; c < 3; ++c) sum += pixel.mean[c];
    return pixels.empty() ? 0 : sum / (3 * static_cast<double>(pixels.size()));
}

bool holds_reference(const fs::path& folder) {
    return fs::exists(folder / state_name);
}

Reference load_reference(const fs::path& folder) {
    constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
    const fs::path file = folder / state_name;
    const trace::Document document(trace::read_file(file, most_state_bytes), file.string());
    const Field root = document.root();
    if (const std::optional<Field> version = root.get("reference_version");
        version && version->value() != Json(schema_version))
        version->fail(version->found(), fmt::format("{}; render the reference again", schema_version));
    root.check(reference_kind);
    const auto number = [&](std::string_view key, std::uint64_t least, std::uint64_t most) {
        return root[key].whole<std::uint64_t>(least, most);
    };
    ReferenceKey key{root["scene"].text(), root["scene_checksum"].text(),
                     root["image_width"].whole(1, most_pixels), root["image_height"].whole(1, most_pixels),
                     number("seed", 0, any)};
    const std::string name = root["moments"].text();
    if (!name.starts_with("moments-") || !name.ends_with(".npy") || name.find('/') != std::string::npos)
        root["moments"].fail(root["moments"].found(), "moments-<samples>.npy");
    const trace::MappedColumn column(folder / name, moments_type());
    const std::uint64_t pixels = std::uint64_t{key.width} * key.height;
    if (column.size() != pixels)
        throw trace::DataError(fmt::format("{}: found {} rows, expected {} x {} pixels",
                                           (folder / name).string(), column.size(), key.width, key.height));
    const std::string checksum = trace::hexadecimal(column.checksum());
    if (const std::string& expected = root["moments_checksum"].text(); checksum != expected)
        throw trace::DataError(fmt::format("{}: found checksum {}, expected {}: altered or damaged",
                                           (folder / name).string(), checksum, trace::shown(expected)));

    Reference reference(std::move(key));
    reference.samples = root["samples"].whole(1, std::numeric_limits<std::uint32_t>::max());
    reference.seconds = root["seconds"].number(0, std::numeric_limits<double>::max(), "a number of seconds");
    if (name != moments_name(reference.samples))
        root["moments"].fail(root["moments"].found(), trace::in_quotes(moments_name(reference.samples)));
    reference.counts.samples = number("paths", 0, any);
    if (reference.counts.samples != reference.samples * pixels)
        root["paths"].fail(root["paths"].found(),
                           fmt::format("{} samples of each of {} pixels", reference.samples, pixels));
    reference.counts.rays = number("rays", 0, any);
    reference.counts.shadow_rays = number("shadow_rays", 0, any);
    reference.counts.cut_off = number("cut_off_paths", 0, any);
    reference.counts.nonfinite.count(Stage::path, number("nonfinite_paths", 0, any));
    const std::span<const Moments> rows = column.rows<Moments>();
    for (std::size_t row = 0; row < rows.size(); ++row)
        check(rows[row], reference.samples, folder / name, row);
    reference.pixels.assign(rows.begin(), rows.end());
    return reference;
}

Reference resume_reference(const fs::path& folder, const ReferenceKey& key) {
    if (!holds_reference(folder)) return Reference(key);
    Reference reference = load_reference(folder);
    const ReferenceKey& found = reference.key;
    const auto refuse = [&](const char* field, const std::string& there, const std::string& asked) {
        throw trace::UsageError(
            fmt::format("{}: {}: found a reference with {}, asked for {}; choose another folder",
                        (folder / state_name).string(), field, there, asked));
    };
    if (found.scene_checksum != key.scene_checksum)
        refuse("scene", fmt::format("{} ({})", found.scene, found.scene_checksum),
               fmt::format("{} ({})", key.scene, key.scene_checksum));
    if (found.width != key.width || found.height != key.height)
        refuse("image size", fmt::format("{} x {}", found.width, found.height),
               fmt::format("{} x {}", key.width, key.height));
    if (found.seed != key.seed) refuse("seed", fmt::format("{}", found.seed), fmt::format("{}", key.seed));
    return reference;
}

void save(const Reference& reference, const fs::path& folder) {
    fs::create_directories(folder);
    const std::string name = moments_name(reference.samples);
    const fs::path partial = folder / (name + ".partial");
    trace::ColumnDigest digest;
    try {
        trace::ColumnWriter writer(partial, moments_type());
        writer.append(std::span<const Moments>(reference.pixels));
        digest = writer.finish(trace::OnDisk::before_return);
        fs::rename(partial, folder / name);
    } catch (...) {
        std::error_code ignored;
        fs::remove(partial, ignored);
        throw;
    }
    trace::sync_folder(folder);

    const Json state = Json::object({{"reference_version", schema_version},
                                     {"scene", reference.key.scene},
                                     {"scene_checksum", reference.key.scene_checksum},
                                     {"image_width", reference.key.width},
                                     {"image_height", reference.key.height},
                                     {"seed", reference.key.seed},
                                     {"samples", reference.samples},
                                     {"seconds", reference.seconds},
                                     {"paths", reference.counts.samples},
                                     {"rays", reference.counts.rays},
                                     {"shadow_rays", reference.counts.shadow_rays},
                                     {"cut_off_paths", reference.counts.cut_off},
                                     {"nonfinite_paths", reference.counts.nonfinite.total()},
                                     {"moments", name},
                                     {"moments_checksum", trace::hexadecimal(digest.checksum)}});
    trace::write_whole(folder / state_name, state.dump(2) + "\n");
    remove_moments_but(folder, name);
}

void write_images(const Reference& reference, const fs::path& folder) {
    const Image mean = reference.mean();
    write_exr(folder / "reference.exr", mean);
    write_exr(folder / "variance.exr", reference.variance());
    write_png(folder / "reference.png", mean, middle_exposure(mean));
}

}  // namespace regather::capture
