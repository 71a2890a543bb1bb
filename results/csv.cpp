#include "results/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "trace/error.h"
#include "trace/file.h"

namespace regather::results {
namespace {

std::string text_cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == text.npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + '"';
}

template <class R>
struct CellWriter {
    const R& row;
    std::string operator()(std::string R::*field) const { return text_cell(row.*field); }
    std::string operator()(Count R::*field) const { return row.*field ? fmt::to_string(*(row.*field)) : ""; }
    std::string operator()(Signed R::*field) const { return row.*field ? fmt::to_string(*(row.*field)) : ""; }
    std::string operator()(Flag R::*field) const { return !(row.*field) ? "" : *(row.*field) ? "1" : "0"; }
    std::string operator()(Ways<R> ways) const {
        return row.*ways.field == std::uint64_t{0} ? "full" : (*this)(ways.field);
    }
    std::string operator()(Seconds<R> seconds) const {
        return row.*seconds.field ? fmt::format("{:.6f}", *(row.*seconds.field)) : "";
    }
    std::string operator()(Real<R> real) const { return number(real.field); }
    std::string operator()(SignedReal<R> real) const { return number(real.field); }

private:
    std::string number(std::optional<double> R::*field) const {
        return row.*field ? fmt::format("{}", *(row.*field)) : "";
    }
};

/// What was found, fit for one line of a message.
std::string shown(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
    return text.size() > 40 ? out + "..." : out;
}

/// Cuts the text into records of cells; remembers lines for messages.
class Records {
public:
    Records(std::string_view text, std::string_view file) : text_(text), file_(file) {
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);  // byte order mark of spreadsheets
    }

    /// False at the end. Empty lines are skipped. line() is that of the record's start.
    bool next(std::vector<std::string>& cells) {
        while (at_ < text_.size() && end_of_line()) step();
        if (at_ >= text_.size()) return false;
        line_ = reading_;
        cells.clear();
        for (;;) {
            const bool quote = at_ < text_.size() && text_[at_] == '"';
            cells.push_back(quote ? quoted_cell(cells.size()) : plain_cell(cells.size()));
            if (at_ >= text_.size()) return true;
            if (end_of_line()) {
                step();
                return true;
            }
            ++at_;  // the comma
        }
    }

    std::size_t line() const { return line_; }

    [[noreturn]] void refuse(std::size_t line, std::size_t cell, std::string_view name,
                             std::string_view found, std::string_view expected) const {
        throw trace::DataError(fmt::format("{}: line {}, column {}{}: found {}, expected {}", file_, line,
                                           cell + 1, name.empty() ? "" : fmt::format(" ({})", shown(name)),
                                           found, expected));
    }

private:
    bool end_of_line() const {
        return text_[at_] == '\n' || (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n');
    }
    void step() {  // over the end of a line
        at_ += text_[at_] == '\r' ? 2 : 1;
        ++reading_;
    }
    std::string plain_cell(std::size_t cell) {
        const std::size_t start = at_;
        while (at_ < text_.size() && text_[at_] != ',' && !end_of_line()) {
            if (text_[at_] == '"')
                refuse(reading_, cell, "", "a quote inside a cell", "quotes around the whole cell");
            ++at_;
        }
        return std::string(text_.substr(start, at_ - start));
    }
    std::string quoted_cell(std::size_t cell) {
        const std::size_t opened = reading_;
        std::string out;
        for (++at_; at_ < text_.size(); ++at_) {
            if (text_[at_] == '"') {
                if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') {
                    ++at_;
                    if (at_ < text_.size() && text_[at_] != ',' && !end_of_line())
                        refuse(reading_, cell, "", "text after a closing quote",
                               "a comma or the end of the line");
                    return out;
                }
                ++at_;
            } else if (text_[at_] == '\n') {
                ++reading_;
            }
            out += text_[at_];
        }
        refuse(opened, cell, "", "a quote that is never closed", "a closing quote");
    }

    std::string_view text_, file_;
    std::size_t at_ = 0, reading_ = 1, line_ = 1;
};

/// Takes a number that fills the whole text.
template <class T>
std::errc parse(const std::string& text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

template <class R>
struct CellReader {
    R& row;
    const std::string& text;
    /// Null, or what was expected.
    const char* operator()(std::string R::*field) const {
        row.*field = text;
        return nullptr;
    }
    const char* operator()(Count R::*field) const {
        return whole(row.*field, "a whole number below 2^64", "a whole number or an empty cell");
    }
    const char* operator()(Signed R::*field) const {
        return whole(row.*field, "a whole number from -2^63 to below 2^63",
                     "a whole number, with a minus when below 0, or an empty cell");
    }
    const char* operator()(Flag R::*field) const {
        if (text != "0" && text != "1") return "1, 0 or an empty cell";
        row.*field = text == "1";
        return nullptr;
    }
    const char* operator()(Ways<R> ways) const {
        if (text == "full") {
            row.*ways.field = 0;
            return nullptr;
        }
        return (*this)(ways.field) != nullptr || row.*ways.field == std::uint64_t{0}
                   ? "a whole number from 1 up, \"full\" or an empty cell"
                   : nullptr;
    }
    const char* operator()(Seconds<R> seconds) const {
        return real(row.*seconds.field, "seconds as a decimal number from 0 up, or an empty cell");
    }
    const char* operator()(Real<R> number) const {
        return real(row.*number.field, "a decimal number from 0 up, or an empty cell");
    }
    const char* operator()(SignedReal<R> number) const {
        double value = 0;
        if (parse(text, value) != std::errc{} || !std::isfinite(value))
            return "a decimal number or an empty cell";
        row.*number.field = value;
        return nullptr;
    }

private:
    template <class T>
    const char* whole(std::optional<T>& field, const char* in_range, const char* expected) const {
        T value = 0;
        const std::errc error = parse(text, value);
        if (error == std::errc::result_out_of_range) return in_range;
        if (error != std::errc{}) return expected;
        field = value;
        return nullptr;
    }
    const char* real(std::optional<double>& field, const char* expected) const {
        double value = 0;
        if (parse(text, value) != std::errc{} || !std::isfinite(value) || std::signbit(value))
            return expected;
        field = value;
        return nullptr;
    }
};

/// Where each known column stands in the file: an index into the cells, or nothing.
template <class R>
std::vector<std::optional<std::size_t>> places(const std::vector<std::string>& header,
                                               const Records& records) {
    std::vector<std::optional<std::size_t>> out;
    for (const Column<R>& column : columns<R>()) {
        const auto first = std::find(header.begin(), header.end(), column.name);
        const auto cell = static_cast<std::size_t>(first - header.begin());
        if (first == header.end()) {
            if (column.needed)
                records.refuse(records.line(), header.size(), column.name, "the end of the header",
                               fmt::format("a column \"{}\"", column.name));
            out.emplace_back();
            continue;
        }
        const auto again = std::find(first + 1, header.end(), column.name);
        if (again != header.end())
            records.refuse(records.line(), static_cast<std::size_t>(again - header.begin()), column.name,
                           "the column a second time", "each column once");
        out.emplace_back(cell);
    }
    return out;
}

std::vector<std::string> header_of(Records& records, std::string_view file) {
    std::vector<std::string> header;
    if (!records.next(header)) throw trace::DataError(fmt::format("{}: empty, expected a header line", file));
    return header;
}

template <class R>
bool has_needed(const std::vector<std::string>& header) {
    return std::ranges::all_of(columns<R>(), [&](const Column<R>& column) {
        return !column.needed || std::find(header.begin(), header.end(), column.name) != header.end();
    });
}

}  // namespace

template <class R>
std::string to_csv(std::type_identity_t<std::span<const R>> rows) {
    std::string out;
    for (const Column<R>& column : columns<R>()) fmt::format_to(std::back_inserter(out), "{},", column.name);
    out.back() = '\n';
    for (const R& row : rows) {
        for (const Column<R>& column : columns<R>()) {
            out += std::visit(CellWriter<R>{row}, column.field);
            out += ',';
        }
        out.back() = '\n';
    }
    return out;
}

template <class R>
std::vector<R> from_csv(std::string_view text, std::string_view file) {
    Records records(text, file);
    const std::vector<std::string> header = header_of(records, file);
    const auto place = places<R>(header, records);

    std::vector<std::string> cells;
    std::vector<R> rows;
    while (records.next(cells)) {
        if (cells.size() != header.size())
            records.refuse(records.line(), std::min(cells.size(), header.size()), "",
                           fmt::format("{} cells", cells.size()),
                           fmt::format("{} as in the header", header.size()));
        R& row = rows.emplace_back();
        for (std::size_t c = 0; c < place.size(); ++c) {
            if (!place[c]) continue;
            const Column<R>& column = columns<R>()[c];
            const std::string& cell = cells[*place[c]];
            const char* expected = nullptr;
            if (!cell.empty())
                expected = std::visit(CellReader<R>{row, cell}, column.field);
            else if (column.name == "ordering")
                expected = "the name of an ordering";
            if (expected != nullptr)
                records.refuse(records.line(), *place[c], column.name, fmt::format("\"{}\"", shown(cell)),
                               expected);
        }
    }
    return rows;
}

template <class R>
void write_csv(const std::filesystem::path& path, std::type_identity_t<std::span<const R>> rows) {
    trace::write_whole(path, to_csv<R>(rows));
}

template <class R>
std::vector<R> read_csv(const std::filesystem::path& path) {
    return from_csv<R>(trace::read_file(path), path.string());
}

RowKind row_kind(std::string_view text, std::string_view file) {
    Records records(text, file);
    const std::vector<std::string> header = header_of(records, file);
    if (has_needed<ConvergenceRow>(header)) return RowKind::convergence;
    if (has_needed<StabilityRow>(header)) return RowKind::stability;
    if (has_needed<SamplingRow>(header)) return RowKind::sampling;
    if (has_needed<TimelineRow>(header)) return RowKind::timeline;
    if (has_needed<DetailRow>(header)) return RowKind::detail;
    return RowKind::measurement;
}

template std::string to_csv<Row>(std::span<const Row>);
template std::string to_csv<DetailRow>(std::span<const DetailRow>);
template std::string to_csv<TimelineRow>(std::span<const TimelineRow>);
template std::string to_csv<SamplingRow>(std::span<const SamplingRow>);
template std::string to_csv<ConvergenceRow>(std::span<const ConvergenceRow>);
template std::string to_csv<StabilityRow>(std::span<const StabilityRow>);
template std::vector<Row> from_csv<Row>(std::string_view, std::string_view);
template std::vector<DetailRow> from_csv<DetailRow>(std::string_view, std::string_view);
template std::vector<TimelineRow> from_csv<TimelineRow>(std::string_view, std::string_view);
template std::vector<SamplingRow> from_csv<SamplingRow>(std::string_view, std::string_view);
template std::vector<StabilityRow> from_csv<StabilityRow>(std::string_view, std::string_view);
template std::vector<ConvergenceRow> from_csv<ConvergenceRow>(std::string_view, std::string_view);
template std::vector<LadderRow> from_csv<LadderRow>(std::string_view, std::string_view);
template void write_csv<Row>(const std::filesystem::path&, std::span<const Row>);
template void write_csv<DetailRow>(const std::filesystem::path&, std::span<const DetailRow>);
template void write_csv<TimelineRow>(const std::filesystem::path&, std::span<const TimelineRow>);
template void write_csv<SamplingRow>(const std::filesystem::path&, std::span<const SamplingRow>);
template void write_csv<StabilityRow>(const std::filesystem::path&, std::span<const StabilityRow>);
template void write_csv<ConvergenceRow>(const std::filesystem::path&, std::span<const ConvergenceRow>);
template std::vector<Row> read_csv<Row>(const std::filesystem::path&);
template std::vector<DetailRow> read_csv<DetailRow>(const std::filesystem::path&);
template std::vector<TimelineRow> read_csv<TimelineRow>(const std::filesystem::path&);
template std::vector<SamplingRow> read_csv<SamplingRow>(const std::filesystem::path&);
template std::vector<StabilityRow> read_csv<StabilityRow>(const std::filesystem::path&);
template std::vector<ConvergenceRow> read_csv<ConvergenceRow>(const std::filesystem::path&);

}  // namespace regather::results
