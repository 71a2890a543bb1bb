// Any bytes as a CSV of rows, of the kind that its header tells; measurements are written so that they are
// read back as they were.
#include "results/rows.h"

#include "results/csv.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    return fuzz::read_or_refuse([&] {
        results::Rows rows;
        rows.add({reinterpret_cast<const char*>(data), size}, "input");
        const std::string csv = results::to_csv(rows.of<results::Row>());
        if (results::to_csv(results::from_csv(csv, "written")) != csv) std::abort();
    });
}
