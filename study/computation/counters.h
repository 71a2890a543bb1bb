// study/computation/counters.h -- what a capture has counted, as values of the parameters of Table 2
// (study/computation/computation.h).
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/progress.h"
#include "study/computation/computation.h"
#include "trace/folder.h"

namespace regather::study {

/// The traces of one capture.
struct CaptureTraces {
    std::unique_ptr<trace::TraceReader> photons;
    std::unique_ptr<trace::TraceReader> caustic_photons;    ///< Null: none.
    std::vector<std::unique_ptr<trace::TraceReader>> rays;  ///< Of `walk --rays`, each kind once.

    std::vector<const trace::TraceReader*> all() const;
};

/// Each folder is a finished trace, or a capture's, whose trace/ is taken. Beside a folder "trace" its
/// "caustic-trace" is taken, too. Throws trace::UsageError for two traces of a kind and for none whose
/// queries search the global photon map; trace::DataError as trace::TraceReader, and for traces of more than
/// one capture.
CaptureTraces open_traces(std::span<const std::filesystem::path> folders);

/// Values with where each is from; an empty source: Table 2's value stands.
struct CountedValues {
    Computation values;
    std::array<std::string, input_count> sources;

    void set(Input input, double value, std::string source);
};

/// How many rays and gathers the capture had, and the constants of Table 2. Throws trace::DataError that
/// names trace.json and the field where a capture's counter is missing, no count, or out of range.
CountedValues counted_values(const CaptureTraces& traces);

/// FLOP of a strategy's table, of which an eye ray makes `tables`, and of a gather ray, on glossy surfaces:
/// the dearer ones. Throws as capture::parse_sampling().
void take_sampling(CountedValues& to, std::string_view spec, double tables);

/// The same, the FLOP of the capture's sampling, and what a gather and a ray met: photons found and looked
/// at; and of the kinds of rays that were walked, inner nodes visited, and the triangles of the leaves
/// visited. A kind that was not walked counts with Table 2's constants in the mean over all rays. Decodes
/// walks. Throws also for walks that are damaged or of another number of rays than the capture counted.
CountedValues measured_values(const CaptureTraces& traces, const experiment::ProgressListener& progress);

}  // namespace regather::study
