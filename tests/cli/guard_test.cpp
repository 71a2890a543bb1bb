// The committed rows of results/guard are what the commands give: every ordering, structure, kind of rows and
// kind of chart, small. A change that is meant to change them makes them again: results/guard/remake.
#include <set>
#include <sstream>

#include "charts/chart.h"
#include "reorder/catalogue.h"
#include "results/rows.h"
#include "tests/cli/expect.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;

fs::path source() {
    const char* folder = std::getenv("REGATHER_SOURCE_DIR");
    return folder == nullptr ? "." : folder;
}

/// Cells that are of the machine and the moment.
bool is_of_the_clock(const results::Column& column) {
    return column.form == results::Form::seconds || column.form == results::Form::signed_seconds ||
           column.name == "efficiency";
}

/// Each row on a line, its cells by name, but for those of the clock; sorted, as the sequence of settings
/// that `converge` takes is the clock's, too.
template <class R>
void tell(const std::vector<R>& rows, std::multiset<std::string>& all) {
    for (const R& row : rows) {
        std::string out(R::kind().name);
        for (const results::Column& column : R::kind().columns)
            if (!is_of_the_clock(column)) {
                out += ' ';
                out += column.name;
                out += '=';
                out += results::cell_text(column, &row);
            }
        all.insert(std::move(out));
    }
}

template <class... R>
struct Telling {
    static std::multiset<std::string> all(const results::Rows& rows) {
        std::multiset<std::string> out;
        (tell(rows.of<R>(), out), ...);
        return out;
    }
};

std::multiset<std::string> told(const fs::path& csv) {
    results::Rows rows;
    EXPECT_THAT(rows.add(results::read_csv_text(csv), csv.string()), testing::IsEmpty());
    return results::EachKind<Telling>::all(rows);
}

/// CSVs below, by their paths in the folder; not the kept parts of a run.
std::set<fs::path> tables(const fs::path& folder) {
    std::set<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".csv" && entry.path().parent_path().filename() != "parts")
            found.insert(fs::relative(entry.path(), folder));
    return found;
}

std::vector<std::vector<std::string>> commands(const fs::path& out) {
    std::vector<std::vector<std::string>> all;
    std::istringstream lines(content(source() / "results/guard/commands.txt"));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::vector<std::string>& command = all.emplace_back();
        for (std::string word; words >> word;) {
            if (const auto at = word.find("OUT"); at != word.npos) word.replace(at, 3, out.string());
            command.push_back(word);
        }
    }
    return all;
}

TEST(SlowGuard, TheCommandsGiveTheCommittedRows) {
    const Scratch scratch;
    fs::current_path(source());
    for (const auto& words : commands(scratch.path())) {
        const Outcome outcome = regather(words);
        ASSERT_EQ(outcome.exit_code, 0) << testing::PrintToString(words) << outcome.err;
    }
    const fs::path committed = source() / "results/guard";
    EXPECT_EQ(tables(scratch.path()), tables(committed));
    for (const fs::path& table : tables(committed))
        EXPECT_EQ(told(scratch / table), told(committed / table)) << table;
}

TEST(Guard, HoldsEveryOrderingStructureKindOfRowsAndKindOfChart) {
    std::set<std::string> orderings, structures, kinds;
    std::set<std::string_view> charts;
    const auto draw = [&](const results::Rows& rows) {
        for (const charts::ChartKind* kind : charts::wanted_kinds(rows, {}))
            if (kind->compose(*kind, rows, {}).skipped.empty()) charts.insert(kind->name);
    };
    results::Rows asked;  // captures that differ in what they ask: one chart
    const fs::path committed = source() / "results/guard";
    for (const fs::path& table : tables(committed)) {
        const std::string text = content(committed / table);
        kinds.insert(std::string(results::row_kind(text, table.string()).name));
        results::Rows rows;
        rows.add(text, table.string());
        for (const results::Row& row : rows.of<results::Row>()) orderings.insert(row.ordering);
        for (const results::RaceRow& row : rows.of<results::RaceRow>()) structures.insert(row.structure);
        draw(rows);
        if (table.parent_path() == "asked") asked.add(text, table.string());
    }
    draw(asked);
    for (const reorder::Entry& entry : reorder::catalogue())
        EXPECT_TRUE(orderings.contains(std::string(entry.name))) << entry.name;
    EXPECT_EQ(structures, (std::set<std::string>{"bucketed", "left-balanced"}));
    EXPECT_EQ(kinds.size(), std::tuple_size_v<results::EachKind<std::tuple>>);
    for (const charts::ChartKind& kind : charts::chart_kinds())
        EXPECT_TRUE(charts.contains(kind.name)) << kind.name;
}

TEST(Results, TellsWhichRowsAreOfThisRenderer) {
    const Scratch scratch;
    fs::create_directories(scratch / "all/deep");
    const fs::path from = source() / "results/guard/converge";
    fs::copy(from / "converge.csv", scratch / "all/a.csv");
    std::string json = content(from / "converge.json");
    write(scratch / "all/a.json", json);
    const Outcome current = regather({"results", (scratch / "all").string()});
    EXPECT_EQ(current.exit_code, 0) << current.err;
    EXPECT_THAT(current.out, testing::HasSubstr("as this one"));
    EXPECT_THAT(current.out, testing::HasSubstr("0 of 1 outdated, 0 not told\n"));

    // Another renderer, another scene, no provenance.
    const auto at = json.find("\"fingerprint\": \"") + 16;
    json[at] = json[at] == '0' ? '1' : '0';
    fs::copy(from / "converge.csv", scratch / "all/b.csv");
    write(scratch / "all/b.json", json);
    fs::copy(from / "converge.csv", scratch / "all/deep/c.csv");
    write(scratch / "all/deep/c.json",
          std::string(json).replace(json.find("\"scene\": \"cornell\""), 18, "\"scene\": \"mine\""));
    fs::copy(from / "converge.csv", scratch / "all/d.csv");
    const Outcome mixed = regather({"results", (scratch / "all").string()});
    EXPECT_EQ(mixed.exit_code, 1);
    EXPECT_THAT(mixed.out, testing::HasSubstr("OUTDATED"));
    EXPECT_THAT(mixed.out, testing::HasSubstr("not told: the scene mine is not embedded: --scene FILE"));
    EXPECT_THAT(mixed.out, testing::HasSubstr("not told: no d.json beside it"));
    EXPECT_THAT(mixed.out, testing::HasSubstr("1 of 4 outdated, 2 not told\n"));
    EXPECT_THAT(mixed.err, testing::HasSubstr("3 of 4 files are not known to be of this renderer"));
    expect_refused(bad_data, {"results", (scratch / "none").string()}, {"none", "no such folder"});
}

}  // namespace
}  // namespace regather::cli
