// experiment/frames.h -- which frames of a camera path: "7", "0,10,20", "0:30:5" (from 0, below 30, every
// fifth).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace regather::experiment {

/// The frames in the order given; all below `count`, which is 0 for a scene without a camera path. Throws
/// trace::UsageError; also for an empty or repeated selection.
std::vector<std::uint32_t> parse_frames(const std::string& text, std::uint32_t count);

/// Where a frame of a capture lies: FOLDER/frame-0005.
std::filesystem::path frame_folder(const std::filesystem::path& folder, std::uint32_t frame);

}  // namespace regather::experiment
