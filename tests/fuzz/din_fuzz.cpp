// Any bytes as an address trace, din text or a column: read to the end with notes of one line, or refused.
#include "cachesim/address_trace.h"

#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace regather;
    return fuzz::read_or_refuse([&] {
        cachesim::AddressTrace trace({fuzz::file_of(data, size, "trace"), {}, {}});
        for (auto records = trace.next(); !records.empty(); records = trace.next())
            for (const cachesim::ByteAccess& record : records)
                if (record.bytes == 0 || record.address + (record.bytes - 1) < record.address) std::abort();
        for (const std::string& note : trace.notes())
            if (note.size() > 1000 || note.find('\n') != note.npos) std::abort();
    });
}
