// imports/targa.h -- Targa images (Truevision TGA File Format Specification 2.0, 1991): plain and run-length
// coded, with a palette, in colour or grey. No library of Debian 12 reads them without dozens of others.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace regather::imports {

/// What the 18 bytes of the header say.
struct Targa {
    enum class Kind : std::uint8_t { palette = 1, colour = 2, grey = 3 };
    Kind kind = Kind::colour;
    bool is_run_length = false;
    std::uint32_t name_bytes = 0;                          ///< Between the header and the palette.
    std::uint32_t palette_first = 0, palette_entries = 0;  ///< Number of the first entry; how many.
    std::uint32_t palette_bits = 0;                        ///< An entry; 0 without a palette.
    std::uint32_t width = 0, height = 0, texel_bits = 0;
    bool has_alpha_bit = false;  ///< Of 16: the topmost one shows the texel.
};

/// Throws trace::DataError, with `name` for the file, for what is not in the list above.
Targa targa_header(std::span<const std::uint8_t> bytes, const std::string& name);

/// width * height texels: red, green, blue and alpha, in the file's order of rows. Throws trace::DataError
/// for data that end early or a colour that the palette does not have.
void read_targa(std::span<const std::uint8_t> bytes, const Targa& header,
                std::span<std::array<std::uint8_t, 4>> texels, const std::string& name);

}  // namespace regather::imports
