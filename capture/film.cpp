#include "capture/film.h"

#include "capture/reference/moments.h"

namespace regather::capture {
namespace {

Vec3 to_float(const std::array<double, 3>& rgb) {
    return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

/// Walks through the queries of one map as the pixels and eye rays pass by.
class Cursor {
public:
    Cursor(const Queries& queries, const Gathered& gathered) : queries_(queries), gathered_(gathered) {}
    /// Calls add(layer, radiance) for each query of the eye ray, in capture order.
    template <class Add>
    std::uint32_t take(std::uint32_t pixel, std::uint32_t sample, const Add& add) {
        const std::size_t first = next_;
        for (; next_ < queries_.size() && queries_.pixel[next_] == pixel && queries_.sample[next_] == sample;
             ++next_)
            add(queries_.layer[next_], queries_.weight[next_] * gathered_.radiance[next_]);
        return static_cast<std::uint32_t>(next_ - first);
    }

private:
    const Queries& queries_;
    const Gathered& gathered_;
    std::size_t next_ = 0;
};

}  // namespace

std::vector<Channel> Layers::channels() const {
    std::vector<Channel> all;
    for (std::size_t l = 0; l < images.size(); ++l)
        for (Channel& channel : channels_of(images[l], layer_names[l])) all.push_back(std::move(channel));
    if (!variance.empty()) all.push_back({"variance.Y", variance});
    all.push_back({"queries.N", {query_count.begin(), query_count.end()}});
    return all;
}

Film::Film(std::uint32_t width, std::uint32_t height, std::uint32_t samples) : samples_(samples) {
    const std::size_t pixels = std::size_t{width} * height;
    image_ = {width, height, {}};
    image_.pixels.reserve(pixels);
    for (Image& layer : layers_.images) {
        layer = {width, height, {}};
        layer.pixels.reserve(pixels);
    }
    layers_.query_count.reserve(pixels);
    if (samples > 1) layers_.variance.reserve(pixels);
}

void Film::add(const PixelWork& work, const Gathered& gathered, const Gathered& caustics) {
    Cursor global(work.queries, gathered), caustic(work.caustic_queries, caustics);
    const auto first_pixel = static_cast<std::uint32_t>(image_.pixels.size());
    const auto count = static_cast<std::uint32_t>(work.radiance.size() / samples_);
    for (std::uint32_t i = 0; i < count; ++i) {
        Sums pixel{};
        MomentsOf<1> seen_light;  // luminance of the eye rays
        std::uint32_t queries = 0;
        for (std::uint32_t s = 0; s < samples_; ++s) {
            Sums sums{};
            const auto add_part = [&](Layer layer, Vec3 radiance) {
                for (int c = 0; c < 3; ++c)
                    sums[static_cast<std::size_t>(layer)][static_cast<std::size_t>(c)] +=
                        static_cast<double>(radiance[c]);
            };
            const auto add_estimate = [&](Layer layer, Vec3 radiance) {
                add_part(layer, nonfinite_.checked(Stage::estimate, radiance));
            };
            const LayeredRadiance& seen = work.radiance[std::size_t{i} * samples_ + s];
            for (std::size_t l = 0; l < seen.size(); ++l) add_part(static_cast<Layer>(l), seen[l]);
            queries += global.take(first_pixel + i, s, add_estimate) +
                       caustic.take(first_pixel + i, s, add_estimate);
            double light = 0;
            for (std::size_t l = 0; l < sums.size(); ++l) {
                light += luminance(sums[l][0], sums[l][1], sums[l][2]);
                for (std::size_t c = 0; c < 3; ++c) pixel[l][c] += sums[l][c];
            }
            seen_light.add({light}, s + 1);
        }
        std::array<double, 3> sum{};
        for (std::size_t l = 0; l < pixel.size(); ++l) {
            for (std::size_t c = 0; c < 3; ++c) {
                pixel[l][c] /= samples_;
                sum[c] += pixel[l][c];
            }
            layers_.images[l].pixels.push_back(to_float(pixel[l]));
        }
        image_.pixels.push_back(to_float(sum));
        layers_.query_count.push_back(queries);
        if (samples_ > 1) layers_.variance.push_back(static_cast<float>(seen_light.variance(0, samples_)));
    }
}

}  // namespace regather::capture
