// Any bytes as the columns of brought walks, and the elements' columns as a trace's own: what is taken is
// read back, decoded and laid out, in one piece.
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "experiment/traces/visits_job.h"
#include "replay/layouts/catalogue.h"
#include "replay/replay.h"
#include "replay/walk_store.h"
#include "spatial/photons/structures.h"
#include "tests/column.h"
#include "tests/fuzz/input.h"
#include "trace/folder.h"

namespace {

using namespace regather;
namespace fs = std::filesystem;

/// Numbers from an input; zeros after its end.
class Numbers {
public:
    explicit Numbers(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    template <class T>
    T next() {
        T value = 0;
        for (std::size_t i = 0; i < sizeof(T) && at_ < bytes_.size(); ++i)
            value |= static_cast<T>(T{bytes_[at_++]} << 8 * i);
        return value;
    }
    template <class T>
    std::vector<T> rows(std::size_t count) {
        std::vector<T> all(count);
        for (T& value : all) value = next<T>();
        return all;
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

enum Flag : unsigned {
    address = 1,
    region = 2,
    level = 4,
    parent = 8,
    overlaps = 16,
    wide = 32,
    short_by_one = 64
};

/// Columns by name, of 4 or 8 bytes a row.
struct Columns {
    std::map<std::string, std::vector<std::uint32_t>> four;
    std::map<std::string, std::vector<std::uint64_t>> eight;
};

void lay_out(const fs::path& folder) {
    trace::TraceReader trace(folder);
    const std::shared_ptr<const spatial::Structure> structure = spatial::open_structure(trace);
    for (const replay::LayoutOrder& order : replay::layout_orders())
        fuzz::read_or_refuse([&] {
            const replay::Layout layout =
                replay::make_layout(std::string(order.name) + "-own", *structure, std::vector<trace::Vec3>{});
            if (layout.first_byte() > layout.end_byte()) std::abort();
        });
    const replay::WalkStore walks(structure, trace.column<std::uint32_t>("query_walk_bytes"),
                                  trace.column<std::uint8_t>("walk"));
    if (replay::touched_elements(walks).size() < structure->end()) std::abort();
}

void bring(const fs::path& folder, const Columns& columns, unsigned flags, std::uint64_t queries) {
    const fs::path mine = folder / "mine", brought = folder / "brought";
    fs::remove_all(mine);
    fs::create_directories(mine);
    for (const auto& [name, rows] : columns.four) write_column<std::uint32_t>(mine / (name + ".npy"), rows);
    for (const auto& [name, rows] : columns.eight) write_column<std::uint64_t>(mine / (name + ".npy"), rows);
    write_column<trace::Vec3>(mine / "query_position.npy", std::vector<trace::Vec3>(queries));
    fuzz::read_or_refuse([&] {
        experiment::run(
            {.columns = mine, .folder = brought, .allow_overlaps = (flags & overlaps) != 0, .force = true},
            {});
        trace::TraceReader(brought).verify_all();
        if (trace::TraceReader(brought).info().visited_nodes != columns.four.at("visit_element").size())
            std::abort();
        lay_out(brought);
    });
}

void open(const fs::path& folder, const Columns& columns, unsigned flags) {
    fuzz::read_or_refuse([&] {
        trace::TraceWriter writer(folder / "told", true);
        for (const auto& [name, rows] : columns.four)
            if (name.starts_with("element_"))
                writer.column(name).append(std::span<const std::uint32_t>(rows));
        for (const auto& [name, rows] : columns.eight)
            if (name.starts_with("element_"))
                writer.column(name).append(std::span<const std::uint64_t>(rows));
        writer.column("query_position").append(std::span<const trace::Vec3>());
        writer.column("query_pixel").append(std::span<const std::uint32_t>());
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>());
        writer.column("walk").append(std::span<const std::uint8_t>());
        trace::TraceInfo info;
        info.scene = "told";
        info.image_width = info.image_height = 1;
        info.structure = spatial::brought_structure;
        if (flags & overlaps) info.parameters["overlaps"] = true;
        writer.finish(info);
        lay_out(folder / "told");
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Numbers numbers({data, size});
    const unsigned flags = numbers.next<std::uint8_t>();
    const std::size_t elements = numbers.next<std::uint8_t>() % 32,
                      queries = numbers.next<std::uint8_t>() % 16, visits = numbers.next<std::uint8_t>();
    Columns columns;
    if (flags & wide)
        columns.eight["query_visits"] = numbers.rows<std::uint64_t>(queries);
    else
        columns.four["query_visits"] = numbers.rows<std::uint32_t>(queries);
    for (const std::uint8_t element : numbers.rows<std::uint8_t>(visits))
        columns.four["visit_element"].push_back(element);
    columns.four["visit_element"].resize(visits);
    columns.four["element_bytes"] = numbers.rows<std::uint32_t>(elements);
    if (flags & region)
        for (const std::uint8_t number : numbers.rows<std::uint8_t>(elements))
            columns.four["element_region"].push_back(number);
    if (flags & parent) columns.four["element_parent"] = numbers.rows<std::uint32_t>(elements);
    if (flags & level) columns.four["element_level"] = numbers.rows<std::uint32_t>(elements);
    if (flags & address) columns.eight["element_address"] = numbers.rows<std::uint64_t>(elements);
    if (flags & short_by_one)
        for (auto& [name, rows] : columns.four)
            if (name == "element_level" && !rows.empty()) rows.pop_back();
    // Its folder is this process's own.
    const fs::path folder = fuzz::file_of(data, size, "input").parent_path();
    bring(folder, columns, flags, queries);
    open(folder, columns, flags);
    return 0;
}
