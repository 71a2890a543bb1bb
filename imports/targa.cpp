#include "imports/targa.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "imports/texture.h"
#include "trace/error.h"

namespace regather::imports {
namespace {

using Texel = std::array<std::uint8_t, 4>;
using Kind = Targa::Kind;

constexpr std::size_t header_bytes = 18;

/// Bytes, one piece after the other.
class Source {
public:
    Source(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    std::span<const std::uint8_t> take(std::size_t count) {
        if (count > bytes_.size())
            throw refused_image(name_,
                                fmt::format("{} bytes before the end of the Targa data", bytes_.size()),
                                fmt::format("{} at least", count));
        const auto piece = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return piece;
    }
    std::uint32_t number(int size) {
        std::uint32_t value = 0;
        int shift = 0;
        for (const std::uint8_t byte : take(static_cast<std::size_t>(size))) {
            value |= std::uint32_t{byte} << shift;
            shift += 8;
        }
        return value;
    }

private:
    std::span<const std::uint8_t> bytes_;
    const std::string& name_;
};

bool is_colour(std::uint32_t bits) {
    return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

std::size_t bytes_of(std::uint32_t bits) {
    return (bits + 7) / 8;
}

/// A colour of 15, 16, 24 or 32 bits. A fourth byte covers whatever the header calls it: games read it so,
/// and many files leave the field 0. The sixteenth bit covers where the header says that it does.
Texel colour(std::span<const std::uint8_t> in, bool has_alpha_bit) {
    if (in.size() == 2) {
        const unsigned word = in[0] | in[1] << 8;
        const auto five = [&](unsigned shift) {
            const unsigned value = word >> shift & 31u;
            return static_cast<std::uint8_t>(value << 3 | value >> 2);
        };
        const bool hidden = has_alpha_bit && word >> 15 == 0;
        return {five(10), five(5), five(0), static_cast<std::uint8_t>(hidden ? 0 : 255)};
    }
    return {in[2], in[1], in[0], in.size() == 4 ? in[3] : std::uint8_t{255}};
}

}  // namespace

Targa targa_header(std::span<const std::uint8_t> bytes, const std::string& name) {
    if (bytes.size() < header_bytes)
        throw refused_image(name, fmt::format("{} bytes", bytes.size()), "the 18 of a Targa header and more");
    Source source(bytes.first(header_bytes), name);
    Targa header;
    header.name_bytes = source.number(1);
    const std::uint32_t has_palette = source.number(1), type = source.number(1);
    header.palette_first = source.number(2);
    header.palette_entries = source.number(2);
    header.palette_bits = source.number(1);
    source.number(4);  // where a screen would show it
    header.width = source.number(2);
    header.height = source.number(2);
    header.texel_bits = source.number(1);
    const std::uint32_t descriptor = source.number(1);
    header.has_alpha_bit = header.texel_bits == 16 && (descriptor & 15) == 1;

    const std::uint32_t kind = type & ~8u;
    if (kind < 1 || kind > 3)
        throw refused_image(name, fmt::format("Targa image type {}", type), "1, 2, 3, 9, 10 or 11");
    header.kind = static_cast<Kind>(kind);
    header.is_run_length = (type & 8) != 0;
    if (has_palette > 1 || (header.kind == Kind::palette && has_palette == 0))
        throw refused_image(name,
                            fmt::format("Targa palette type {} in an image of type {}", has_palette, type),
                            header.kind == Kind::palette ? "1" : "0 or 1");
    if (has_palette == 0) header.palette_entries = header.palette_bits = 0;
    if (has_palette == 1 && !is_colour(header.palette_bits))
        throw refused_image(name, fmt::format("a Targa palette of {} bits an entry", header.palette_bits),
                            "15, 16, 24 or 32");
    if (header.kind == Kind::colour ? !is_colour(header.texel_bits) : header.texel_bits != 8)
        throw refused_image(
            name, fmt::format("{} bits a texel in a Targa image of type {}", header.texel_bits, type),
            header.kind == Kind::colour ? "15, 16, 24 or 32" : "8");
    if (descriptor >> 6 != 0)
        throw refused_image(name, "a Targa image with interleaved rows", "rows one after the other");
    return header;
}

void read_targa(std::span<const std::uint8_t> bytes, const Targa& header, std::span<Texel> texels,
                const std::string& name) {
    Source source(bytes, name);
    source.take(header_bytes + header.name_bytes);
    std::vector<Texel> palette(header.palette_entries);
    for (Texel& entry : palette) entry = colour(source.take(bytes_of(header.palette_bits)), false);
    const auto next = [&]() -> Texel {
        const auto in = source.take(bytes_of(header.texel_bits));
        if (header.kind == Kind::colour) return colour(in, header.has_alpha_bit);
        if (header.kind == Kind::grey) return {in[0], in[0], in[0], 255};
        const std::uint32_t entry = in[0] - header.palette_first;
        if (in[0] < header.palette_first || entry >= palette.size())
            throw refused_image(name, fmt::format("colour {} of a Targa palette", in[0]),
                                fmt::format("{} entries from {}", palette.size(), header.palette_first));
        return palette[entry];
    };
    for (std::size_t at = 0; at < texels.size();) {
        if (!header.is_run_length) {
            texels[at++] = next();
            continue;
        }
        const std::uint32_t packet = source.number(1);
        const std::size_t count = (packet & 127) + 1;
        if (count > texels.size() - at)
            throw refused_image(
                name, fmt::format("a Targa run of {} texels where {} are left", count, texels.size() - at),
                "no more than are left");
        const bool is_run = (packet & 128) != 0;
        const Texel repeated = is_run ? next() : Texel{};
        for (std::size_t i = 0; i < count; ++i) texels[at++] = is_run ? repeated : next();
    }
}

}  // namespace regather::imports
