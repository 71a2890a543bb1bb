#include "imports/texture.h"

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <memory>

#include "imports/targa.h"
#include "trace/error.h"

namespace regather::imports {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// Texels for an image of this size.
Texture blank(std::int64_t width, std::int64_t height, const std::string& name) {
    if (width < 1 || height < 1 || width > most_texture_edge || height > most_texture_edge)
        throw refused_image(name, fmt::format("{} x {} texels", width, height),
                            fmt::format("1 x 1 to {0} x {0}", most_texture_edge));
    Texture texture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    texture.texels.resize(std::size_t{texture.width} * texture.height);
    return texture;
}

Texture read_jpeg(Bytes bytes, const std::string& name) {
    const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
    if (!decoder) throw std::runtime_error("the JPEG decoder cannot be started");
    const auto damaged = [&] { return refused_image(name, "damaged JPEG data", "an undamaged image"); };
    int width = 0, height = 0, subsampling = 0, colours = 0;
    const bool is_read = tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height,
                                             &subsampling, &colours) == 0;
    if (!is_read || width < 1 || height < 1)  // 0 x 0 when the header ends early
        throw damaged();
    Texture texture = blank(width, height, name);
    const bool inks = colours == TJCS_CMYK || colours == TJCS_YCCK;
    auto* first = texture.texels.data()->data();
    // A warning stops, too: what libjpeg goes on from after one is grey where the file ended early.
    if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), first, width, 0, height,
                      inks ? TJPF_CMYK : TJPF_RGBA,
                      TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) != 0)
        throw damaged();
    if (inks)  // as Adobe writes them: 255 is no ink
        for (auto& [r, g, b, a] : texture.texels) {
            const auto shown = [black = a](std::uint8_t ink) {
                return static_cast<std::uint8_t>((ink * black + 127) / 255);
            };
            r = shown(r), g = shown(g), b = shown(b), a = 255;
        }
    return texture;
}

Texture read_png(Bytes bytes, const std::string& name) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const std::unique_ptr<png_image, void (*)(png_image*)> decoder(&image, png_image_free);
    const auto damaged = [&] { return refused_image(name, "damaged PNG data", "an undamaged image"); };
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) throw damaged();
    image.format = PNG_FORMAT_RGBA;
    image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    Texture texture = blank(image.width, image.height, name);
    if (png_image_finish_read(&image, nullptr, texture.texels.data(), 0, nullptr) == 0) throw damaged();
    return texture;
}

bool begins(Bytes bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

}  // namespace

trace::DataError refused_image(const std::string& name, std::string_view found, std::string_view expected) {
    return trace::DataError(fmt::format("{}: found {}, expected {}", name, found, expected));
}

Texture read_texture(Bytes bytes, const std::string& name) {
    if (begins(bytes, "\xff\xd8\xff")) return read_jpeg(bytes, name);
    if (begins(bytes, "\x89PNG\r\n\x1a\n")) return read_png(bytes, name);
    if (!name.ends_with(".tga"))
        throw refused_image(name, "another format", "JPEG, PNG, or Targa in a file .tga");
    const Targa targa = targa_header(bytes, name);
    Texture texture = blank(targa.width, targa.height, name);
    read_targa(bytes, targa, texture.texels, name);
    return texture;
}

}  // namespace regather::imports
