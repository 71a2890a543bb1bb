// capture/images/exr_bytes.h -- floating-point pictures as the bytes of an OpenEXR file.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace regather::capture {

/// One channel: "R", or "direct.R" of the layer "direct".
struct Channel {
    std::string name;
    std::vector<float> values;  ///< In row order, first row at the top.
};

/// Scan lines of 32-bit floats, zip-compressed; bit for bit the values given. All channels have `width` x
/// `height` values. The same channels give the same bytes: no date, no name of a machine.
std::string exr_bytes(std::uint32_t width, std::uint32_t height, std::span<const Channel> channels);

}  // namespace regather::capture
