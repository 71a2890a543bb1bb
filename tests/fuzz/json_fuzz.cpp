// Any bytes as JSON: what is read is written so that it is read back as it was.
#include "trace/json.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    return fuzz::read_or_refuse([&] {
        const trace::Json json = trace::parse_json({reinterpret_cast<const char*>(data), size}, "input");
        for (const int indent : {-1, 0, 2}) {
            const std::string text = json.dump(indent);
            const trace::Json again = trace::parse_json(text, "written");
            if (again != json || again.dump(indent) != text) std::abort();
        }
    });
}
