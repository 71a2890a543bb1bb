// experiment/revisits.h -- what no order changes (replay::Revisits), as text, to be kept between runs.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "replay/replay.h"

namespace regather::experiment {

std::string text_of(const replay::Revisits& revisits);
/// Throws trace::DataError that names the file when the text is not what text_of() writes.
replay::Revisits revisits_in(std::string_view text, const std::filesystem::path& file);

}  // namespace regather::experiment
