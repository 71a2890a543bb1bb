#include "capture/images/image_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "capture/images/image_error.h"
#include "capture/images/lettering.h"

namespace regather::capture {
namespace {

namespace fs = std::filesystem;
using Rgb8 = std::array<std::uint8_t, 3>;

constexpr std::uint32_t least_panel = 256, margin = 10, letter_size = 13, letter_height = 16, text_gap = 6,
                        bar_width = 16, tick = 5, bar_text = 60;
constexpr Rgb8 paper{255, 255, 255}, ink{32, 32, 32};

class Canvas {
public:
    Canvas(std::uint32_t width, std::uint32_t height)
        : picture_{width, height, std::vector<Rgb8>(std::size_t{width} * height, paper)} {}

    void fill(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height, Rgb8 colour) {
        for (std::uint32_t j = y; j < std::min(y + height, picture_.height); ++j)
            for (std::uint32_t i = x; i < std::min(x + width, picture_.width); ++i)
                picture_.pixels[std::size_t{j} * picture_.width + i] = colour;
    }
    void write(std::uint32_t x, std::uint32_t y, std::string_view text, std::uint32_t most_width) {
        const Lettering line = lettering(text, letter_size, most_width);
        for (std::uint32_t j = 0; j < std::min(line.height, picture_.height - y); ++j)
            for (std::uint32_t i = 0; i < std::min(line.width, picture_.width - x); ++i) {
                const unsigned covered = line.ink[std::size_t{j} * line.width + i];
                Rgb8& pixel = picture_.pixels[std::size_t{y + j} * picture_.width + x + i];
                for (std::size_t c = 0; c < 3; ++c)
                    pixel[c] = static_cast<std::uint8_t>(
                        (pixel[c] * (255 - covered) + ink[c] * covered + 127) / 255);
            }
    }
    template <class Colour>
    void panel(std::uint32_t x, std::uint32_t y, std::uint32_t columns, std::uint32_t rows,
               std::uint32_t scale, Colour colour) {
        for (std::uint32_t j = 0; j < rows; ++j)
            for (std::uint32_t i = 0; i < columns; ++i)
                fill(x + i * scale, y + j * scale, scale, scale, colour(std::size_t{j} * columns + i));
    }
    Picture take() { return std::move(picture_); }

private:
    Picture picture_;
};

}  // namespace

std::vector<float> signed_error(const Image& image, const Image& reference) {
    check_comparable(image, reference, "image");
    double mean = 0;
    for (const trace::Vec3 pixel : reference.pixels) mean += luminance(pixel);
    const double least = 0.01 * mean / static_cast<double>(reference.pixels.size());
    std::vector<float> out(reference.pixels.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double truth = luminance(reference.pixels[i]), error = luminance(image.pixels[i]) - truth;
        const double scale = std::max(truth, least);
        out[i] = scale > 0 ? static_cast<float>(error / scale) : error == 0 ? 0.0f : 1.0f;
    }
    return out;
}

float error_range(const std::vector<float>& errors) {
    std::vector<float> sizes(errors.size());
    std::transform(errors.begin(), errors.end(), sizes.begin(), [](float e) { return std::abs(e); });
    std::sort(sizes.begin(), sizes.end());
    const float bound = sizes.empty() ? 0 : sizes[(sizes.size() - 1) * 95 / 100];
    if (bound <= 0) return 0.01f;
    const double decade = std::pow(10.0, std::floor(std::log10(static_cast<double>(bound))));
    for (const double digit : {1.0, 2.0, 5.0})
        if (static_cast<double>(bound) <= digit * decade * (1 + 1e-6))
            return static_cast<float>(digit * decade);
    return static_cast<float>(10 * decade);
}

Rgb8 false_colour(float error, float range) {
    // Blue and red of one lightness, both safe for colour-blind readers; between them and white straight
    // lines.
    constexpr std::array<float, 3> cold{33, 102, 172}, warm{178, 24, 43}, none{255, 255, 255};
    const float t = std::clamp(error / range, -1.0f, 1.0f), size = std::abs(t);
    Rgb8 out{};
    for (std::size_t c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>(none[c] + ((t < 0 ? cold : warm)[c] - none[c]) * size + 0.5f);
    return out;
}

Picture image_strip(const Image& image, const Image& reference, const StripText& text) {
    const std::vector<float> errors = signed_error(image, reference);
    const float range = error_range(errors), exposure = middle_exposure(reference);
    const std::uint32_t columns = reference.width, rows = reference.height;
    const std::uint32_t scale = std::max(1u, (least_panel + columns - 1) / columns);
    const std::uint32_t panel = columns * scale, height = rows * scale,
                        top = margin + letter_height + text_gap;
    const std::uint32_t bar = 3 * (panel + margin) + margin;
    Canvas canvas(bar + bar_width + tick + text_gap + bar_text + margin,
                  top + std::max(height, 4 * letter_height) + margin);
    const auto title = [&](std::uint32_t x, const std::string& words) {
        canvas.write(x, margin, words, panel);
    };
    const std::uint32_t second = 2 * margin + panel, third = 3 * margin + 2 * panel;
    title(margin, text.image);
    title(second, text.reference);
    title(third, "error");
    canvas.panel(margin, top, columns, rows, scale,
                 [&](std::size_t i) { return on_screen(image.pixels[i], exposure); });
    canvas.panel(second, top, columns, rows, scale,
                 [&](std::size_t i) { return on_screen(reference.pixels[i], exposure); });
    canvas.panel(third, top, columns, rows, scale,
                 [&](std::size_t i) { return false_colour(errors[i], range); });

    canvas.fill(bar - 1, top - 1, bar_width + 2, height + 2, ink);
    for (std::uint32_t y = 0; y < height; ++y)
        canvas.fill(
            bar, top + y, bar_width, 1,
            false_colour(range * (1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height)),
                         range));
    const std::string bound = fmt::format("{:.3g}%", 100 * static_cast<double>(range));
    const auto mark = [&](std::uint32_t y, std::uint32_t text_y, const std::string& label) {
        canvas.fill(bar + bar_width, y, tick, 1, ink);
        canvas.write(bar + bar_width + tick + text_gap, text_y, label, bar_text);
    };
    mark(top, top, "+" + bound);
    mark(top + height / 2, top + (height - letter_height) / 2, "0");
    mark(top + height - 1, top + height - letter_height, "-" + bound);
    return canvas.take();
}

void write_strip(const fs::path& path, const Picture& picture) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * picture.pixels.size());
    for (const auto& pixel : picture.pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.end());
    write_png(path, picture.width, picture.height, bytes);
}

}  // namespace regather::capture
