#include "capture/images/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/capture.h"
#include "capture/images/lettering.h"
#include "trace/error.h"

namespace regather::capture {

namespace {

constexpr std::uint32_t margin = 6, label = 18, letter_size = 13;  // [pixels]
constexpr float background = 0.9f;

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
    Image sheet{width, height, std::vector<trace::Vec3>(std::size_t{width} * height)};
    std::fill(sheet.pixels.begin(), sheet.pixels.end(), trace::Vec3{background, background, background});
    for (std::uint32_t i = 0; i < count; ++i) {
        if (progress) progress(all[i].name, i);
        const std::uint32_t left = margin + i % columns * (config.edge + margin);
        const std::uint32_t top = margin + i / columns * (config.edge + label + margin);
        const Image image = rendering(all[i], config);
        for (std::uint32_t y = 0; y < config.edge; ++y)
            std::copy_n(image.pixels.begin() + std::size_t{y} * config.edge, config.edge,
                        sheet.pixels.begin() + std::size_t{top + y} * width + left);
        const Lettering name = lettering(all[i].name, letter_size, config.edge);
        const std::uint32_t name_left = left + (config.edge - name.width) / 2;
        for (std::uint32_t y = 0; y < std::min(name.height, label); ++y)
            for (std::uint32_t x = 0; x < name.width; ++x) {
                const float paper = 1 - static_cast<float>(name.ink[std::size_t{y} * name.width + x]) / 255;
                trace::Vec3& pixel = sheet.pixels[std::size_t{top + config.edge + y} * width + name_left + x];
                pixel = pixel * paper;
            }
    }
    return sheet;
}

}  // namespace regather::capture
