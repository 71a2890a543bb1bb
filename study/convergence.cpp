#include "study/convergence.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include "capture/images/flip.h"
#include "capture/images/image_error.h"
#include "study/interior.h"
#include "trace/digest.h"
#include "trace/median.h"

namespace regather::study {
namespace {

/// Display values before their sRGB encoding: 1 - exp(-x), the curve of image.png, all under the reference's
/// exposure.
capture::Image view(const capture::Image& image, float exposure) {
    capture::Image out = image;
    for (trace::Vec3& pixel : out.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = 1 - std::exp(-std::max(0.0f, pixel[c] * exposure));
    return out;
}

double diagonal_of(const scenes::Scene& scene) {
    const trace::Bounds3 box = scene.bounds();
    return static_cast<double>(trace::length(box.max - box.min));
}

class Clock {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double mean_of(const capture::Image& image, const std::vector<std::uint8_t>& mask) {
    double sum = 0, values = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (mask[i] == 0) continue;
        for (int c = 0; c < 3; ++c) sum += static_cast<double>(image.pixels[i][c]);
        values += 3;
    }
    return sum / values;
}

std::uint64_t pixels_in(const std::vector<std::uint8_t>& mask) {
    return static_cast<std::uint64_t>(std::count(mask.begin(), mask.end(), 1));
}

}  // namespace

capture::CaptureConfig capture_config(const Setting& setting, const ConvergenceConfig& config,
                                      std::uint64_t seed) {
    capture::CaptureConfig out;
    out.pixels.width = config.width;
    out.pixels.height = config.height;
    out.pixels.gather_rays = setting.gather_rays;
    out.pixels.shadow_rays = config.shadow_rays;
    out.pixels.samples = setting.samples;
    if (!setting.sampling.empty()) out.pixels.sampling = setting.sampling;
    out.pixels.irradiance_cache = setting.irradiance_cache;
    out.pixels.jitter = true;
    out.pixels.visualisation = setting.mode;
    out.pixels.seed = seed;
    out.photon.photons = setting.photons;
    out.photon.seed = setting.photon_seed.value_or(seed);
    out.gather.k = setting.k;
    out.gather.radius = static_cast<float>(setting.radius);
    out.caustic.photons = setting.caustic_photons;
    out.precompute_every = setting.precompute_every;
    out.reverse_pixels = setting.reverse_pixels;
    out.columns = {.rays = false, .direction = false, .leaf_kd = false, .leaf_bvh = false, .stratum = false};
    return out;
}

std::vector<std::uint8_t> counted_pixels(const capture::Image& image) {
    std::vector<float> brightness;
    for (const trace::Vec3 pixel : image.pixels) brightness.push_back(pixel.x + pixel.y + pixel.z);
    const float most = 10 * static_cast<float>(trace::upper_median({brightness.begin(), brightness.end()}));
    std::vector<std::uint8_t> mask(brightness.size(), 1);
    if (most <= 0) return mask;  // half the image is black
    const auto w = static_cast<std::int64_t>(image.width), h = static_cast<std::int64_t>(image.height);
    for (std::int64_t y = 0; y < h; ++y)
        for (std::int64_t x = 0; x < w; ++x) {
            if (brightness[static_cast<std::size_t>(y * w + x)] <= most) continue;
            for (std::int64_t v = std::max<std::int64_t>(y - 1, 0); v <= std::min(y + 1, h - 1); ++v)
                for (std::int64_t u = std::max<std::int64_t>(x - 1, 0); u <= std::min(x + 1, w - 1); ++u)
                    mask[static_cast<std::size_t>(v * w + u)] = 0;
        }
    return mask;
}

Truth truth_of(const capture::Reference& reference) {
    return {reference.mean(), reference.variance().pixels, reference.samples};
}

std::string checksum(const Truth& truth) {
    trace::Digest mean(truth.mean.width);
    mean.add_all(std::span(truth.mean.pixels));
    trace::Digest both(mean.value());
    both.add_all(std::span(truth.variance));
    return both.hexadecimal();
}

Convergence::Convergence(const scenes::Scene& scene, Truth truth, const ConvergenceConfig& config)
    : scene_(scene), truth_(std::move(truth)), config_(config), truth_checksum_(checksum(truth_)) {
    capture::Image expected{config.width, config.height, truth_.mean.pixels};
    capture::check_comparable(truth_.mean, expected, "reference");
    if (config_.interior_radius <= 0) config_.interior_radius = diagonal_of(scene) / 20;
    counted_ = counted_pixels(truth_.mean);
    if (pixels_in(counted_) == 0) counted_.assign(counted_.size(), 1);
    interior_ =
        interior(scene, capture::RayCaster(scene), config.width, config.height, config_.interior_radius);
    for (std::size_t i = 0; i < interior_.size(); ++i) interior_[i] &= counted_[i];
    reference_rmse_ = std::sqrt(error_parts({&truth_.mean, 1}, truth_, counted_).reference_variance);
}

double Convergence::mean_radiance() const {
    return mean_of(truth_.mean, counted_);
}

void Convergence::describe(results::ConvergenceRow& row, const Setting& setting) const {
    row.scene = scene_.name;
    row.reference = truth_checksum_;
    row.ladder = setting.ladder;
    row.mode = mode_name(setting.mode);
    row.gather_rays = setting.gather_rays;
    row.photons = setting.photons;
    row.k = setting.k;
    if (std::isfinite(setting.radius)) row.radius = setting.radius;
    row.caustic_photons = setting.caustic_photons;
    row.samples = setting.samples;
    row.sampling = setting.sampling;
    row.irradiance_cache = setting.irradiance_cache;
    if (setting.precompute_every > 0) row.precompute_every = setting.precompute_every;
    if (setting.reverse_pixels > 0) row.reverse_pixels = setting.reverse_pixels;
    row.photon_seed = setting.photon_seed;
    row.shadow_rays = config_.shadow_rays;
    row.width = config_.width;
    row.height = config_.height;
    row.seeds = config_.seeds;
    row.interior_radius = config_.interior_radius;
}

bool Convergence::belongs(const results::ConvergenceRow& row) const {
    results::ConvergenceRow own;
    describe(own, {});
    const auto key = [](const results::ConvergenceRow& r) {
        return std::tie(r.scene, r.reference, r.shadow_rays, r.width, r.height, r.seeds, r.interior_radius);
    };
    return key(row) == key(own);
}

bool Convergence::holds(const results::ConvergenceRow& row, const Setting& setting) const {
    results::ConvergenceRow own;
    describe(own, setting);
    const auto key = [](const results::ConvergenceRow& r) {
        return std::tie(r.ladder, r.mode, r.gather_rays, r.photons, r.k, r.radius, r.caustic_photons,
                        r.samples, r.sampling, r.irradiance_cache, r.precompute_every, r.reverse_pixels,
                        r.photon_seed);
    };
    return row.total_seconds && row.rmse && belongs(row) && key(row) == key(own);
}

Measured Convergence::measure(const Setting& setting, const std::function<void(std::uint32_t)>& told) const {
    Measured out;
    results::ConvergenceRow& row = out.row;
    describe(row, setting);
    std::vector<capture::Image> images, indirect;
    double render = 0, photon = 0, tree = 0, rel_mse = 0, trimmed = 0, mape = 0, ldr = 0, hdr = 0;
    std::uint64_t nonfinite = 0;
    const float exposure = capture::middle_exposure(truth_.mean);
    const capture::Image shown = view(truth_.mean, exposure);
    const double share = 1.0 / config_.seeds;
    for (std::uint32_t seed = 0; seed < config_.seeds; ++seed) {
        const capture::Captured captured =
            capture::capture(scene_, capture_config(setting, config_, config_.first_seed + seed));
        render += share * (captured.query_seconds + captured.gather_seconds);
        photon += share * captured.photon_seconds;
        tree += share * captured.tree_seconds;
        nonfinite += captured.nonfinite.total();
        const capture::ImageErrors errors = capture::image_errors(captured.image, truth_.mean);
        rel_mse += share * errors.rel_mse;
        trimmed += share * errors.rel_mse_trimmed;
        mape += share * errors.mape;
        ldr += share * capture::mean_flip(capture::ldr_flip(view(captured.image, exposure), shown));
        hdr += share * capture::mean_flip(capture::hdr_flip(captured.image, truth_.mean));
        images.push_back(captured.image);
        indirect.push_back(captured.layers[capture::Layer::indirect]);
        if (told) told(seed + 1);
    }
    row.render_seconds = render;
    row.photon_seconds = photon;
    row.tree_seconds = tree;
    row.total_seconds = render + photon + tree;
    row.rel_mse = rel_mse;
    row.rel_mse_trimmed = trimmed;
    row.mape = mape;
    row.ldr_flip = ldr;
    row.hdr_flip = hdr;
    row.nonfinite = nonfinite;
    row.pixels = pixels_in(counted_);
    row.mean_radiance = mean_radiance();
    row.reference_rmse = reference_rmse_;

    const ErrorParts all = error_parts(images, truth_, counted_);
    row.below_reference = all.squared_error <= all.reference_variance;
    row.rmse = std::sqrt(std::max(all.squared_error, all.reference_variance));
    row.variance = all.variance;
    row.variance_stderr = all.variance_stderr;
    if (setting.mode == capture::Visualisation::final_gather && setting.gather_rays > 0) {
        const ErrorParts gathered = error_parts(indirect, {truth_.mean, {}, 0}, counted_);
        row.indirect_variance = gathered.variance;
        row.indirect_variance_stderr = gathered.variance_stderr;
    }
    row.bias_squared = all.bias_squared;
    row.bias_squared_stderr = all.bias_squared_stderr;
    if (all.variance.value_or(0) > 0 && *row.total_seconds > 0)
        row.efficiency = 1 / (*all.variance * *row.total_seconds);
    row.interior_pixels = pixels_in(interior_);
    if (*row.interior_pixels > 0) {
        const ErrorParts inside = error_parts(images, truth_, interior_);
        row.interior_variance = inside.variance;
        row.interior_bias_squared = inside.bias_squared;
        row.interior_bias_squared_stderr = inside.bias_squared_stderr;
        row.interior_mean_radiance = mean_of(truth_.mean, interior_);
    }
    out.first = std::move(images.front());
    return out;
}

double CostModel::photon_work(const Setting& setting) const {
    return static_cast<double>(setting.photons) + static_cast<double>(setting.caustic_photons);
}

double CostModel::render_work(const Setting& setting) const {
    // In photons looked at: a gather ray and the nodes on the way down are taken for 50, an eye path for 100.
    return static_cast<double>(pixels_) * setting.samples *
           ((setting.mode == capture::Visualisation::direct ? 1.0 : setting.gather_rays) *
                (50.0 + setting.k) +
            100);
}

double CostModel::seconds(const Setting& setting) const {
    return seeds_ * (photon_seconds_ * photon_work(setting) + render_seconds_ * render_work(setting) +
                     analysis_seconds_ * static_cast<double>(pixels_));
}

void CostModel::learn(const Setting& setting, const results::ConvergenceRow& row, double elapsed) {
    const double photon = row.photon_seconds.value_or(0) + row.tree_seconds.value_or(0);
    if (photon > 0 && photon_work(setting) > 0) photon_seconds_ = photon / photon_work(setting);
    render_seconds_ = row.render_seconds.value_or(0) / render_work(setting);
    analysis_seconds_ =
        std::max(0.0, elapsed / seeds_ - row.total_seconds.value_or(0)) / static_cast<double>(pixels_);
}

std::vector<Setting> run(const Convergence& convergence, const ConvergenceConfig& config,
                         const LadderRun& ladder) {
    const Clock clock;
    CostModel model(std::uint64_t{config.width} * config.height, config.seeds);
    std::vector<Setting> left;
    for (const Setting& setting : ladder.settings)
        if (std::none_of(ladder.known.begin(), ladder.known.end(),
                         [&](const auto& row) { return convergence.holds(row, setting); }))
            left.push_back(setting);
    double done = 0;
    bool any = false;
    while (!left.empty()) {
        // The model changes with each measurement, so the next one is chosen afresh.
        const auto next = std::min_element(left.begin(), left.end(), [&](const Setting& a, const Setting& b) {
            return model.seconds(a) < model.seconds(b);
        });
        const Setting setting = *next;
        const double predicted = model.seconds(setting), time_left = ladder.seconds - clock.seconds();
        // The first predictions are guesses: one setting is always measured.
        if (any && predicted > time_left) break;
        left.erase(next);
        any = true;
        double ahead = predicted;
        for (const Setting& other : left) ahead += model.seconds(other);
        ahead = std::min(ahead, std::max(time_left, predicted));
        const auto tell = [&](std::uint32_t images) {
            const double now = done + predicted * images / config.seeds;
            if (ladder.progress) ladder.progress(setting, now / (done + ahead));
        };
        tell(0);
        const Clock own;
        const Measured measured = convergence.measure(setting, tell);
        model.learn(setting, measured.row, own.seconds());
        done = clock.seconds();
        ladder.measured(setting, measured);
    }
    return left;
}

}  // namespace regather::study
