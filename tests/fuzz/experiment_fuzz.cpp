// Any bytes as an experiment file.
#include "experiment/experiment.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    return fuzz::read_or_refuse([&] {
        const experiment::Experiment read =
            experiment::load_experiment(fuzz::file_of(data, size, "experiment.json"));
        if (read.trials.empty()) std::abort();
        experiment::reads(read);
    });
}
