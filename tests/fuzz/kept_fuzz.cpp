// Any bytes as a part that an experiment kept, and as the counts in it.
#include "experiment/kept.h"
#include "experiment/revisits.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    return fuzz::read_or_refuse([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        experiment::read_kept(fuzz::file_of(data, size, "part"), "key");
        const std::string written = experiment::text_of(experiment::revisits_in(text, "input"));
        if (experiment::text_of(experiment::revisits_in(written, "written")) != written) std::abort();
    });
}
