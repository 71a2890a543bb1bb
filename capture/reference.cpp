#include "capture/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "trace/error.h"
#include "trace/npy.h"

namespace regather::capture {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int schema_version = 1;
constexpr std::uint32_t most_pixels = 32768;  // along an edge
const char* const state_name = "reference.json";

const trace::ColumnType& moments_type() {
    static const trace::ColumnType type{"'<f8'", "6", sizeof(Moments), "float64 x 6"};
    return type;
}

std::string hexadecimal(std::uint64_t number) {
    return fmt::format("{:016x}", number);
}

/// The fields of reference.json, with one line for each that is not what it should be.
class State {
public:
    explicit State(fs::path path) : path_(std::move(path)) {
        std::ifstream file(path_);
        if (!file)
            throw trace::DataError(fmt::format(
                "{}: cannot be opened; is this a folder that regather reference wrote?", path_.string()));
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        root_ = json::parse(text, nullptr, false);
        if (!root_.is_object())
            throw trace::DataError(fmt::format("{}: found no JSON object", path_.string()));
    }
    std::uint64_t number(const char* field, std::uint64_t least, std::uint64_t most) const {
        const json& value = at(field);
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least ||
            value.get<std::uint64_t>() > most)
            fail(field, value, fmt::format("a whole number from {} to {}", least, most));
        return value.get<std::uint64_t>();
    }
    double seconds(const char* field) const {
        const json& value = at(field);
        if (!value.is_number() || !(value.get<double>() >= 0) || !std::isfinite(value.get<double>()))
            fail(field, value, "a number of seconds");
        return value.get<double>();
    }
    std::string text(const char* field) const {
        const json& value = at(field);
        if (!value.is_string()) fail(field, value, "a text");
        return value.get<std::string>();
    }
    [[noreturn]] void fail(const char* field, const json& found, const std::string& expected) const {
        throw trace::DataError(
            fmt::format("{}: {}: found {}, expected {}", path_.string(), field,
                        found.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 60), expected));
    }

private:
    const json& at(const char* field) const {
        const auto found = root_.find(field);
        if (found == root_.end())
            throw trace::DataError(fmt::format("{}: {}: not there", path_.string(), field));
        return *found;
    }
    fs::path path_;
    json root_;
};

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
    if (all.empty()) return 0;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return *middle;
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
    const State state(folder / state_name);
    if (const std::uint64_t version = state.number("reference_version", 0, any); version != schema_version)
        state.fail("reference_version", version,
                   fmt::format("{}; render the reference again", schema_version));
    ReferenceKey key{state.text("scene"), state.text("scene_checksum"),
                     static_cast<std::uint32_t>(state.number("image_width", 1, most_pixels)),
                     static_cast<std::uint32_t>(state.number("image_height", 1, most_pixels)),
                     state.number("seed", 0, any)};
    const std::string name = state.text("moments");
    if (!name.starts_with("moments-") || !name.ends_with(".npy") || name.find('/') != std::string::npos)
        state.fail("moments", name, "moments-<samples>.npy");
    const trace::MappedColumn column(folder / name, moments_type());
    const std::uint64_t pixels = std::uint64_t{key.width} * key.height;
    if (column.size() != pixels)
        throw trace::DataError(fmt::format("{}: found {} rows, expected {} x {} pixels",
                                           (folder / name).string(), column.size(), key.width, key.height));
    const std::string checksum = hexadecimal(column.checksum());
    if (const std::string expected = state.text("moments_checksum"); checksum != expected)
        throw trace::DataError(fmt::format("{}: found checksum {}, expected {}: altered or damaged",
                                           (folder / name).string(), checksum, expected));

    Reference reference(std::move(key));
    reference.samples =
        static_cast<std::uint32_t>(state.number("samples", 1, std::numeric_limits<std::uint32_t>::max()));
    reference.seconds = state.seconds("seconds");
    reference.counts.samples = state.number("paths", 0, any);
    reference.counts.rays = state.number("rays", 0, any);
    reference.counts.shadow_rays = state.number("shadow_rays", 0, any);
    reference.counts.cut_off = state.number("cut_off_paths", 0, any);
    reference.counts.nonfinite.count(Stage::path, state.number("nonfinite_paths", 0, any));
    const std::span<const Moments> rows = column.rows<Moments>();
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
    const std::string name = fmt::format("moments-{}.npy", reference.samples),
                      partial = fmt::format("partial-{}", state_name);
    trace::ColumnWriter writer(folder / (name + ".partial"), moments_type());
    writer.append(std::span<const Moments>(reference.pixels));
    const trace::ColumnDigest digest = writer.finish();
    fs::rename(folder / (name + ".partial"), folder / name);

    const json state{{"reference_version", schema_version},
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
                     {"moments_checksum", hexadecimal(digest.checksum)}};
    {
        std::ofstream file(folder / partial);
        file << state.dump(2) << "\n";
        if (!file.flush())
            throw std::runtime_error(fmt::format("{}: cannot be written", (folder / partial).string()));
    }
    fs::rename(folder / partial, folder / state_name);
    remove_moments_but(folder, name);
}

void write_images(const Reference& reference, const fs::path& folder) {
    const Image mean = reference.mean();
    write_exr(folder / "reference.exr", mean);
    write_exr(folder / "variance.exr", reference.variance());
    write_png(folder / "reference.png", mean, middle_exposure(mean));
}

}  // namespace regather::capture
