#include "capture/contact_sheet.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/capture.h"
#include "trace/error.h"

namespace regather::capture {

namespace {

constexpr std::uint32_t margin = 6, label = 18;  // [pixels]
constexpr float background = 0.9f;
constexpr const char* font = "DejaVuSans";

Image rendering(const scenes::Scene& scene, const ContactSheetConfig& config) {
    CaptureConfig capturing;
    capturing.pixels.width = capturing.pixels.height = config.edge;
    capturing.pixels.gather_rays = config.gather_rays;
    capturing.pixels.shadow_rays = config.shadow_rays;
    capturing.photon.photons = config.photons;
    capturing.gather.k = config.k;
    Image image = capture(scene, capturing).image;
    const float exposure = middle_exposure(image);
    for (trace::Vec3& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = 1 - std::exp(-exposure * pixel[c]);
    return image;
}

}  // namespace

Image contact_sheet(std::span<const scenes::Scene> all, const ContactSheetConfig& config,
                    const std::function<void(std::string_view, std::size_t)>& progress) {
    if (all.empty()) throw trace::UsageError("contact sheet: found no scene, expected at least one");
    const auto count = static_cast<std::uint32_t>(all.size());
    const std::uint32_t columns = std::min(config.columns, count), rows = (count + columns - 1) / columns;
    const std::uint32_t width = margin + columns * (config.edge + margin);
    const std::uint32_t height = margin + rows * (config.edge + label + margin);
    OIIO::ImageBuf sheet(
        OIIO::ImageSpec(static_cast<int>(width), static_cast<int>(height), 3, OIIO::TypeDesc::FLOAT));
    const float white[] = {background, background, background}, black[] = {0, 0, 0};
    OIIO::ImageBufAlgo::fill(sheet, white);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (progress) progress(all[i].name, i);
        const std::uint32_t left = margin + i % columns * (config.edge + margin);
        const std::uint32_t top = margin + i / columns * (config.edge + label + margin);
        const Image image = rendering(all[i], config);
        for (std::uint32_t y = 0; y < config.edge; ++y)
            for (std::uint32_t x = 0; x < config.edge; ++x) {
                const trace::Vec3 p = image.pixels[std::size_t{y} * config.edge + x];
                const float rgb[] = {p.x, p.y, p.z};
                sheet.setpixel(static_cast<int>(left + x), static_cast<int>(top + y), 0, rgb);
            }
        // Without the font it changes nothing and says so in the buffer's error, which nobody asks for.
        OIIO::ImageBufAlgo::render_text(sheet, static_cast<int>(left + config.edge / 2),
                                        static_cast<int>(top + config.edge + label - 4), all[i].name, 13,
                                        font, black, OIIO::ImageBufAlgo::TextAlignX::Center);
        if (sheet.has_error()) sheet.geterror();
    }
    Image result{width, height, std::vector<trace::Vec3>(std::size_t{width} * height)};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            float rgb[3];
            sheet.getpixel(static_cast<int>(x), static_cast<int>(y), 0, rgb, 3);
            result.pixels[std::size_t{y} * width + x] = {rgb[0], rgb[1], rgb[2]};
        }
    return result;
}

}  // namespace regather::capture
