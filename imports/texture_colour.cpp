#include "imports/texture_colour.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using trace::in_quotes;

namespace {

std::array<double, 256> srgb_decoded() {
    std::array<double, 256> table;
    for (int i = 0; i < 256; ++i) {
        const double s = i / 255.0;
        table[static_cast<std::size_t>(i)] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    }
    return table;
}

}  // namespace

trace::Vec3 mean_colour(std::span<const std::uint8_t> bytes, const std::string& name) {
    const auto refuse = [&](std::string_view found, std::string_view expected) {
        throw trace::DataError(fmt::format("{}: found {}, expected {}", name, found, expected));
    };
    const auto ending = [&](std::string_view text) { return name.ends_with(text); };
    const char* format = ending(".jpg") || ending(".jpeg") ? "jpeg" : ending(".png") ? "png" : "targa";
    OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
    OIIO::ImageSpec wish, spec;
    wish["oiio:UnassociatedAlpha"] = 1;
    const auto image = OIIO::ImageInput::create(format);
    if (!image || !image->supports("ioproxy")) refuse(format, "a format that OpenImageIO reads from memory");
    image->set_ioproxy(&memory);
    if (!image->open(name, spec, wish)) refuse(in_quotes(image->geterror()), "an undamaged image");
    if (spec.width < 1 || spec.height < 1 || spec.width > 8192 || spec.height > 8192 || spec.depth > 1)
        refuse(fmt::format("{} x {} texels", spec.width, spec.height), "8192 x 8192 at most");
    if (spec.nchannels < 1 || spec.nchannels > 4)
        refuse(fmt::format("{} channels", spec.nchannels), "1 to 4");
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    const auto width = static_cast<std::size_t>(spec.width);
    std::vector<std::uint8_t> row(width * static_cast<std::size_t>(spec.height) * channels);
    if (!image->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, row.data()))
        refuse(in_quotes(image->geterror()), "an undamaged image");
    static const std::array<double, 256> decoded = srgb_decoded();
    const bool has_alpha = channels == 2 || channels == 4;
    std::array<double, 3> sum{}, opaque_sum{};
    double weight = 0;
    const std::size_t texels = row.size() / channels;
    for (std::size_t i = 0; i < texels; ++i) {
        const std::uint8_t* texel = &row[i * channels];
        const double alpha = has_alpha ? texel[channels - 1] / 255.0 : 1;
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = decoded[texel[channels >= 3 ? c : 0]];
            sum[c] += alpha * value;
            opaque_sum[c] += value;
        }
        weight += alpha;
    }
    if (weight <= 0)
        sum = opaque_sum, weight = static_cast<double>(texels);  // An alpha channel that hides all.
    return {static_cast<float>(sum[0] / weight), static_cast<float>(sum[1] / weight),
            static_cast<float>(sum[2] / weight)};
}

}  // namespace regather::imports
