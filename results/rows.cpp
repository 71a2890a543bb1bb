#include "results/rows.h"

#include <algorithm>

namespace regather::results {
namespace {

template <class... R>
struct Kinds {
    static std::vector<const RowKind*> all() { return {&R::kind()...}; }
};

bool has(const std::vector<std::string>& header, const Column& column) {
    return std::find(header.begin(), header.end(), column.name) != header.end();
}

}  // namespace

const RowKind& row_kind(std::string_view text, std::string_view file) {
    const std::vector<std::string> header = header_of(text, file);
    const RowKind* likeliest = nullptr;
    std::ptrdiff_t most = 0;
    for (const RowKind* kind : EachKind<Kinds>::all()) {
        const auto& columns = kind->columns;
        if (std::all_of(columns.begin(), columns.end(),
                        [&](const Column& column) { return !column.needed || has(header, column); }))
            return *kind;
        const std::ptrdiff_t shared = std::count_if(
            columns.begin(), columns.end(), [&](const Column& column) { return has(header, column); });
        if (shared >= most) likeliest = kind;
        most = std::max(most, shared);
    }
    return *likeliest;
}

std::vector<std::string> Rows::add(std::string_view text, std::string_view file) {
    const RowKind& kind = row_kind(text, file);
    std::vector<std::string> unknown;
    const auto read_into = [&]<class R>(std::vector<R>& rows) {
        if (&R::kind() == &kind)
            from_csv(
                kind, text, file, [&]() -> void* { return &rows.emplace_back(); }, &unknown);
    };
    std::apply([&](auto&... rows) { (read_into(rows), ...); }, tables_);
    return unknown;
}

}  // namespace regather::results
