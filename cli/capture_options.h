// cli/capture_options.h -- what a capture can be asked for, as options of a command.
#pragma once
#include "cli/command.h"
#include "experiment/traces/capture_options.h"

namespace regather::cli {

/// Bound to `options`, whose values are the defaults.
void add_capture_options(Command& command, experiment::CaptureOptions& options);

/// What only the values tell. Throws trace::UsageError for options that the others leave without effect.
void check_capture_options(const Command& command, const experiment::CaptureOptions& options);

}  // namespace regather::cli
