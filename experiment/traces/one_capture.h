// experiment/traces/one_capture.h -- traces that are of one capture: its photon maps, those in other
// structures, and its rays.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "trace/folder.h"

namespace regather::experiment {

/// Of trace::ray_kinds, for a trace of `walk --rays`; null for others.
const std::string* kind_of_rays(const trace::TraceInfo& info);

/// "gather rays", "photons", "caustic photons".
std::string part_name(const trace::TraceInfo& info);

/// As the capture that a trace is of was asked for.
const trace::Json& capture_parameters(const trace::TraceInfo& info);

/// Throws trace::DataError that names trace.json of `other` unless both are of one capture. `of` ends the
/// message: "the traces of a frame".
void check_one_capture(const trace::TraceReader& first, const trace::TraceReader& other, std::string_view of);

/// XXH3-64 over the checksums of the traces in their order, in hexadecimal.
std::string checksum_of(std::span<const trace::TraceReader* const> traces);

/// For provenance: checksum and parameters of each trace by its part_name(), under `key`; and the renderer
/// of the first.
trace::Json parameters_of(std::span<const trace::TraceReader* const> traces, std::string_view key);

}  // namespace regather::experiment
