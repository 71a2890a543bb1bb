#include "results/csv.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <set>

#include "results/rows.h"
#include "tests/results/folder.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::results {
namespace {

constexpr const char* first_header =
    "scene,frame,ordering,tile,bins,structure,layout,policy,cache_bytes,line_bytes,ways,queries,accesses,"
    "raw_bytes,oracle_bytes,compulsory_bytes,misses,traffic_bytes,reorder_bytes,key_ops,moved_records,"
    "buffered_bytes,recast_rays,order_seconds,replay_seconds";
constexpr const char* further_header =
    ",parameters,keys,sort_passes,stalls,compulsory,capacity,conflict,writebacks,onchip_bytes,"
    "buffer_traffic_bytes,net_benefit_bytes,set_sampling,sampled_sets,misses_stderr,misses_low,misses_high,"
    "sampling,irradiance_cache\n";

/// What from_csv() says against `text`; "" when it takes it.
template <class R = Row>
std::string refusal(std::string_view text) {
    try {
        from_csv<R>(text, "mine.csv");
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "";
}

rc::Gen<std::string> any_text() {
    return rc::gen::container<std::string>(rc::gen::element('a', ',', '"', '\n', '\r', ' ', '7', '\xC3'));
}
rc::Gen<Count> any_count() {
    return rc::gen::oneOf(
        rc::gen::just(Count()),
        rc::gen::map(rc::gen::arbitrary<std::uint64_t>(), [](std::uint64_t n) { return Count(n); }),
        rc::gen::just(Count(UINT64_MAX)), rc::gen::just(Count(0)));
}

TEST(Csv, BeginsWithTheColumnsOfTheContractInTheirOrder) {
    EXPECT_EQ(to_csv({}), std::string(first_header) + further_header);
}

TEST(Csv, WritesAMeasurementAsDrawnByHand) {
    Row row;
    row.scene = "room";
    row.ordering = "direction-binned";
    row.tile = 16;
    row.bins = 8;
    row.parameters = "direction-binned:tile=16,bins=8";
    row.structure = "left-balanced-kd";
    row.layout = "heap-20";
    row.policy = "lru";
    row.cache_bytes = 131072;
    row.line_bytes = 128;
    row.ways = 0;
    row.queries = 1000;
    row.accesses = 140000;
    row.misses = 0;
    row.traffic_bytes = 0;
    row.order_seconds = 0.25;
    row.replay_seconds = 12;
    row.net_benefit_bytes = -20;
    row.misses_stderr = 0.1;
    row.sampling = "combined:rows=4";
    row.irradiance_cache = "hessian";
    EXPECT_EQ(to_csv(std::span(&row, 1)),
              std::string(first_header) + further_header +
                  "room,,direction-binned,16,8,left-balanced-kd,heap-20,lru,131072,128,full,1000,140000,"
                  ",,,0,0,,,,,,0.250000,12.000000,\"direction-binned:tile=16,bins=8\",,,,,,,,,,-20,,,0.1,,,"
                  "combined:rows=4,"
                  "hessian\n");
}

/// Puts any value that the column can hold into a row's field.
struct Filler {
    Form form;
    void operator()(std::string* field) const {
        *field = *any_text();
        *field += 'x';  // an ordering has a name
    }
    void operator()(Count* field) const { *field = *any_count(); }
    void operator()(Signed* field) const {
        if (*rc::gen::arbitrary<bool>())
            *field = *rc::gen::oneOf(rc::gen::arbitrary<std::int64_t>(), rc::gen::just(INT64_MIN));
    }
    void operator()(Flag* field) const {
        if (*rc::gen::arbitrary<bool>()) *field = *rc::gen::arbitrary<bool>();
    }
    void operator()(Number* field) const {
        if (!*rc::gen::arbitrary<bool>()) return;
        if (form == Form::seconds) *field = *rc::gen::inRange(0, 100000000) / 1e6;
        if (form == Form::signed_seconds) *field = *rc::gen::inRange(-100000000, 100000000) / 1e6;
        if (form == Form::real) *field = std::abs(*rc::gen::arbitrary<double>());
        if (form == Form::signed_real) *field = *rc::gen::arbitrary<double>();
    }
};
/// The value of a field as text that tells any two values apart.
struct Value {
    std::string operator()(const std::string* field) const { return *field; }
    template <class T>
    std::string operator()(const std::optional<T>* field) const {
        if (!*field) return "nothing";
        if constexpr (std::is_same_v<T, double>)
            return fmt::format("{:a}", **field);
        else
            return fmt::to_string(**field);
    }
};
const auto size_of = [](const auto* field) { return sizeof(*field); };
const auto address_of = [](const auto* field) -> const void* { return field; };

template <class R>
void gives_back_every_column_of_any_rows() {
    SCOPED_TRACE(R::kind().name);
    EXPECT_TRUE(rc::check([] {
        std::vector<R> rows(static_cast<std::size_t>(*rc::gen::inRange(0, 4)));
        for (R& row : rows)
            for (const Column& column : R::kind().columns) std::visit(Filler{column.form}, column.cell(&row));
        auto back = from_csv<R>(to_csv<R>(rows), "memory");
        RC_ASSERT(back.size() == rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (const Column& column : R::kind().columns)
                RC_ASSERT(std::visit(Value{}, column.cell(&back[i])) ==
                          std::visit(Value{}, column.cell(&rows[i])));
    }));
}

/// No two columns share a name or a field, and no field is forgotten: a row of optional cells and texts is as
/// large as its columns' fields, up to padding.
template <class R>
void has_a_column_for_each_field() {
    SCOPED_TRACE(R::kind().name);
    std::set<std::string_view> names;
    std::set<const void*> fields;
    R row;
    std::size_t bytes = 0;
    for (const Column& column : R::kind().columns) {
        EXPECT_TRUE(names.insert(column.name).second) << column.name;
        EXPECT_TRUE(fields.insert(std::visit(address_of, column.cell(&row))).second) << column.name;
        bytes += std::visit(size_of, column.cell(&row));
    }
    EXPECT_LE(bytes, sizeof(R));
    EXPECT_LT(sizeof(R) - bytes, alignof(R));
}

template <class R>
void is_told_by_its_header() {
    EXPECT_EQ(row_kind(to_csv<R>({}), "mine.csv").name, R::kind().name);
}

template <class... R>
struct OfEachKind {
    static void give_back() { (gives_back_every_column_of_any_rows<R>(), ...); }
    static void have_columns() { (has_a_column_for_each_field<R>(), ...); }
    static void are_told() { (is_told_by_its_header<R>(), ...); }
};

TEST(CsvOfEachKind, GivesBackEveryColumnOfAnyRows) {
    EachKind<OfEachKind>::give_back();
    gives_back_every_column_of_any_rows<LadderRow>();
}
TEST(CsvOfEachKind, HasAColumnForEachField) {
    EachKind<OfEachKind>::have_columns();
}
TEST(CsvOfEachKind, IsToldByItsHeader) {
    EachKind<OfEachKind>::are_told();
}

TEST(Csv, OfAnUnknownHeaderIsTakenForTheLikeliestKind) {
    EXPECT_EQ(row_kind("a,b\n", "mine.csv").name, "measurement");
    EXPECT_EQ(
        row_kind("misses,ordering,cache_bytes,line_bytes,ways,slice,first_query,queries\n", "mine.csv").name,
        "timeline");
    // Without the needed "machine" it still is nothing else.
    EXPECT_EQ(row_kind("machin,level,region,accesses,row_hits\n", "mine.csv").name, "machine");
    EXPECT_THROW(row_kind("", "mine.csv"), trace::DataError);
}

TEST(Csv, AMisspeltColumnIsRefusedWithItsNameAndAStrangeOneIsTold) {
    const std::string header = "ordering,cache_bytes,line_bytes,ways,traffic_bytes";
    EXPECT_EQ(refusal(header + ",mises\n"),
              "mine.csv: line 1, column 6 (mises): found a column that is not known, expected \"misses\"");
    EXPECT_EQ(
        refusal("ordering,cache_bytes,line_byte,ways,traffic_bytes\n"),
        "mine.csv: line 1, column 3 (line_byte): found a column that is not known, expected \"line_bytes\"");
    // "raw_bytes" is near to no column that is absent, as raw_bytes is there.
    EXPECT_EQ(refusal(header + ",raw_bytes,raw_bytes_2\n"), "");
    Rows rows;
    EXPECT_THAT(rows.add(header + ",note,queries,my own\nnaive,1,2,3,4,five,6,7\n", "mine.csv"),
                testing::ElementsAre("note", "my own"));
    ASSERT_EQ(rows.of<Row>().size(), 1u);
    EXPECT_EQ(rows.of<Row>()[0].queries, 6u);
    EXPECT_TRUE(rows.of<DetailRow>().empty());
}

TEST(Csv, WritesTheOtherKindsAsDrawnByHand) {
    DetailRow detail;
    detail.scene = "room";
    detail.ordering = "hilbert";
    detail.tile = 16;
    detail.cache_bytes = 131072;
    detail.line_bytes = 128;
    detail.ways = 0;
    detail.region = "photons";
    detail.tree_depth = 3;
    detail.accesses = 10;
    detail.misses = 4;
    detail.compulsory = 1;
    detail.capacity = 2;
    detail.conflict = 1;
    detail.traffic_bytes = 512;
    detail.used_bytes = 100;
    EXPECT_EQ(
        to_csv<DetailRow>(std::span(&detail, 1)),
        "scene,ordering,tile,bins,parameters,layout,policy,cache_bytes,line_bytes,ways,region,tree_depth,"
        "accesses,misses,compulsory,capacity,conflict,traffic_bytes,used_bytes\n"
        "room,hilbert,16,,,,,131072,128,full,photons,3,10,4,1,2,1,512,100\n");
    TimelineRow slice;
    slice.ordering = "naive";
    slice.cache_bytes = 4096;
    slice.line_bytes = 64;
    slice.ways = 1;
    slice.slice = 2;
    slice.first_query = 200;
    slice.queries = 100;
    slice.accesses = 900;
    slice.misses = 50;
    EXPECT_EQ(
        to_csv<TimelineRow>(std::span(&slice, 1)),
        "scene,ordering,tile,bins,parameters,cache_bytes,line_bytes,ways,slice,first_query,queries,accesses,"
        "misses\n,naive,,,,4096,64,1,2,200,100,900,50\n");
    SamplingRow sampled;
    sampled.ordering = "naive";
    sampled.cache_bytes = 4096;
    sampled.line_bytes = 64;
    sampled.ways = 8;
    sampled.set_sampling = 16;
    sampled.seed = 7;
    sampled.misses = 90;
    sampled.misses_stderr = 2.5;
    sampled.misses_low = 85;
    sampled.misses_high = 95;
    sampled.exact_misses = 96;
    sampled.covered = false;
    sampled.seconds = 0.5;
    sampled.exact_seconds = 8;
    EXPECT_EQ(to_csv<SamplingRow>(std::span(&sampled, 1)),
              "scene,ordering,parameters,cache_bytes,line_bytes,ways,set_sampling,seed,misses,misses_stderr,"
              "misses_low,misses_high,exact_misses,covered,seconds,exact_seconds\n"
              ",naive,,4096,64,8,16,7,90,2.5,85,95,96,0,0.500000,8.000000\n");
}

TEST(Csv, WritesRacesCachesAndMachinesAsDrawnByHand) {
    RaceRow race;
    race.scene = "a, b";
    race.structure = "bucketed";
    race.ordering = "hilbert";
    race.tile = 16;
    race.parameters = "hilbert:tile=16,bits=9";
    race.queries = 700;
    race.photons = 90;
    race.k = 5;
    race.gathered = true;
    race.threads = 2;
    race.repeats = 3;
    race.order_seconds_median = 0.25;
    race.search_seconds_median = 1;
    race.search_seconds_min = 0.5;
    race.search_seconds_max = 2;
    race.search_seconds_mad = 0.125;
    race.net_gain_seconds = -0.75;
    EXPECT_EQ(to_csv<RaceRow>(std::span(&race, 1)),
              "scene,structure,ordering,tile,bins,parameters,queries,photons,k,threads,repeats,"
              "order_seconds_median,search_seconds_median,search_seconds_min,search_seconds_max,"
              "search_seconds_mad,net_gain_seconds,radius,gathered\n"
              "\"a, b\",bucketed,hilbert,16,,\"hilbert:tile=16,bits=9\",700,90,5,2,3,0.250000,1.000000,"
              "0.500000,2.000000,0.125000,-0.750000,,1\n");
    CacheRow cache;
    cache.policy = "random";
    cache.size_bytes = 4096;
    cache.line_bytes = 64;
    cache.ways = 0;
    cache.accesses = 9;
    cache.hits = 4;
    cache.misses = 5;
    cache.writebacks = 1;
    cache.writes_through = 2;
    cache.traffic_bytes = 384;
    cache.write = "through";
    cache.write_miss = "no-allocate";
    cache.index = "hashed";
    cache.seed = 7;
    EXPECT_EQ(
        to_csv<CacheRow>(std::span(&cache, 1)),
        "policy,size_bytes,line_bytes,ways,accesses,hits,misses,compulsory,capacity,conflict,writebacks,"
        "writes_through,traffic_bytes,write,write_miss,index,seed\n"
        "random,4096,64,full,9,4,5,,,,1,2,384,through,no-allocate,hashed,7\n");
    MachineRow machine;
    machine.layout = "heap-20";
    machine.machine = "mine, \"the\" first";
    machine.level = "L2";
    machine.region = "photons";
    machine.accesses = 5;
    machine.bytes_out = 64;
    machine.picojoules = 0.5;
    EXPECT_EQ(
        to_csv<MachineRow>(std::span(&machine, 1)),
        "scene,structure,layout,ordering,parameters,machine,level,region,accesses,hits,misses,sector_misses,"
        "victim_hits,writebacks,clean_victims,writes_through,back_invalidations,prefetches,useful_prefetches,"
        "bytes_in,"
        "bytes_out,bursts_read,bursts_written,row_hits,row_empty,row_conflicts,picojoules\n"
        ",,heap-20,,,\"mine, \"\"the\"\" first\",L2,photons,5,,,,,,,,,,,,64,,,,,,0.5\n");
    FrameRow frame;
    static_cast<MachineRow&>(frame) = machine;
    frame.scene = "room";
    frame.frame = 3;
    frame.unit = "tile=16";
    frame.run = "apart";
    frame.part = "gather rays";
    frame.queries = 9;
    EXPECT_EQ(
        to_csv<FrameRow>(std::span(&frame, 1)),
        "scene,frame,unit,run,part,structure,layout,ordering,parameters,machine,level,region,queries,"
        "accesses,"
        "hits,misses,sector_misses,victim_hits,writebacks,clean_victims,writes_through,back_invalidations,"
        "prefetches,useful_prefetches,bytes_in,bytes_out,bursts_read,bursts_written,row_hits,row_empty,"
        "row_conflicts,picojoules\n"
        "room,3,tile=16,apart,gather rays,,heap-20,,,\"mine, \"\"the\"\" "
        "first\",L2,photons,9,5,,,,,,,,,,,,64,"
        ",,,,,0.5\n");
}

TEST(Csv, RefusesBadCellsAndMissingColumnsOfTheOtherKinds) {
    const std::string row_header =
        "ordering,cache_bytes,line_bytes,ways,traffic_bytes,net_benefit_bytes,misses_stderr\n";
    for (const char* text : {"-", "+5", "1.0", "0x1", " 1", "--1"})
        EXPECT_EQ(refusal(row_header + "naive,1,1,1,1," + text + ",\n"),
                  std::string("mine.csv: line 2, column 6 (net_benefit_bytes): found \"") + text +
                      "\", expected a whole number, with a minus when below 0, or an empty cell");
    for (const char* text : {"9223372036854775808", "-9223372036854775809"})
        EXPECT_EQ(refusal(row_header + "naive,1,1,1,1," + text + ",\n"),
                  std::string("mine.csv: line 2, column 6 (net_benefit_bytes): found \"") + text +
                      "\", expected a whole number from -2^63 to below 2^63");
    EXPECT_EQ(refusal(row_header + "naive,1,1,1,1,-9223372036854775808,1e3\n"), "");
    for (const char* text : {"nan", "inf", "-1", "1e999", "1,5", "2s"})
        EXPECT_NE(
            refusal(row_header + "naive,1,1,1,1,,\"" + text + "\"\n").find("column 7 (misses_stderr): found"),
            std::string::npos);
    const std::string sampling_header =
        "ordering,cache_bytes,line_bytes,ways,set_sampling,misses,exact_misses,seconds,covered\n";
    for (const char* text : {"2", "true", "01", "-1"})
        EXPECT_EQ(refusal<SamplingRow>(sampling_header + "naive,1,1,1,2,1,1,1," + text + "\n"),
                  std::string("mine.csv: line 2, column 9 (covered): found \"") + text +
                      "\", expected 1, 0 or an empty cell");
    EXPECT_EQ(refusal<DetailRow>("ordering,cache_bytes,line_bytes,ways,region,misses\n"),
              "mine.csv: line 1, column 7 (tree_depth): found the end of the header, expected a column "
              "\"tree_depth\"");
    EXPECT_EQ(refusal<TimelineRow>("ordering,cache_bytes,line_bytes,ways,slice,queries,misses\n"),
              "mine.csv: line 1, column 8 (first_query): found the end of the header, expected a column "
              "\"first_query\"");
    EXPECT_EQ(
        refusal<DetailRow>(
            "ordering,cache_bytes,line_bytes,ways,region,tree_depth,misses\nnaive,1,1,1,photons,-1,2\n"),
        "mine.csv: line 2, column 6 (tree_depth): found \"-1\", expected a whole number or an empty cell");
}

TEST(Csv, TakesRowsThatSomebodyElseWrote) {
    const auto rows = from_csv(
        "\xEF\xBB\xBF"
        "traffic_bytes,note,ways,ordering,line_bytes,cache_bytes\r\n"
        "17,\"a \"\"remark\"\", with\na line\",full,\"my order\",64,4096\r\n"
        "\r\n"
        ",,4,naive,64,8192",
        "mine.csv");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].ordering, "my order");
    EXPECT_EQ(rows[0].traffic_bytes, 17u);
    EXPECT_EQ(rows[0].ways, 0u);
    EXPECT_EQ(rows[1].traffic_bytes, std::nullopt);
    EXPECT_EQ(rows[1].cache_bytes, 8192u);
    EXPECT_EQ(rows[1].queries, std::nullopt);
}

TEST(Csv, RefusesABadCellByFileLineColumnFoundAndExpected) {
    const std::string header = "ordering,cache_bytes,line_bytes,ways,traffic_bytes,order_seconds\n";
    EXPECT_EQ(refusal(header + "naive,4096,64,8,1,\nnaive,4096,64,8,12x,\n"),
              "mine.csv: line 3, column 5 (traffic_bytes): found \"12x\", expected a whole number or an "
              "empty cell");
    // A cell with a line end inside moves the lines after it.
    EXPECT_EQ(
        refusal(header + "\"na\nive\",4096,64,8,1,\nnaive,-1,64,8,1,\n"),
        "mine.csv: line 4, column 2 (cache_bytes): found \"-1\", expected a whole number or an empty cell");
    EXPECT_EQ(
        refusal(header + "naive,4096,64,0,1,\n"),
        "mine.csv: line 2, column 4 (ways): found \"0\", expected a whole number from 1 up, \"full\" or an "
        "empty cell");
    EXPECT_EQ(
        refusal(header + "naive,18446744073709551616,64,1,1,\n"),
        "mine.csv: line 2, column 2 (cache_bytes): found \"18446744073709551616\", expected a whole number "
        "below 2^64");
    for (const char* seconds : {"nan", "inf", "-0.5", "1s", "1e999"})
        EXPECT_EQ(refusal(header + "naive,4096,64,8,1," + seconds + "\n"),
                  std::string("mine.csv: line 2, column 6 (order_seconds): found \"") + seconds +
                      "\", expected seconds as a decimal number from 0 up, or an empty cell");
    EXPECT_EQ(refusal(header + ",4096,64,8,1,\n"),
              "mine.csv: line 2, column 1 (ordering): found \"\", expected a name");
}

TEST(Csv, RefusesAFileThatIsNoTable) {
    EXPECT_EQ(refusal(""), "mine.csv: found nothing, expected a header line");
    EXPECT_EQ(refusal("\n\n"), "mine.csv: found nothing, expected a header line");
    EXPECT_EQ(refusal("ordering,cache_bytes,line_bytes,ways\n"),
              "mine.csv: line 1, column 5 (traffic_bytes): found the end of the header, expected a column "
              "\"traffic_bytes\"");
    EXPECT_EQ(refusal("ordering,cache_bytes,line_bytes,ways,traffic_bytes,ways\n"),
              "mine.csv: line 1, column 6 (ways): found the column a second time, expected each column once");
    const std::string header = "ordering,cache_bytes,line_bytes,ways,traffic_bytes\n";
    EXPECT_EQ(refusal(header + "naive,1,2,3\n"),
              "mine.csv: line 2, column 5: found 4 cells, expected 5 as in the header");
    EXPECT_EQ(refusal(header + "naive,1,2,3,4,5\n"),
              "mine.csv: line 2, column 6: found 6 cells, expected 5 as in the header");
    EXPECT_EQ(
        refusal(header + "na\"ive,1,2,3,4\n"),
        "mine.csv: line 2, column 1: found a quote inside a cell, expected quotes around the whole cell");
    EXPECT_EQ(refusal(header + "naive,\"1\"2,2,3,4\n"),
              "mine.csv: line 2, column 2: found text after a closing quote, expected a comma or the end of "
              "the line");
    EXPECT_EQ(refusal(header + "naive,1,2,3,4\nnaive,\"1,2,\n3,4\n"),
              "mine.csv: line 3, column 2: found a quote that is never closed, expected a closing quote");
    EXPECT_EQ(refusal(header), "");
}

TEST(Csv, NoCutOrAlteredFileCrashesTheReader) {
    Row row;
    row.ordering = "na\"ive,";
    row.cache_bytes = 4096;
    row.order_seconds = 1.5;
    const std::vector<Row> rows(3, row);
    const std::string whole = to_csv(rows);
    for (std::size_t size = 0; size <= whole.size(); ++size) refusal(std::string_view(whole).substr(0, size));
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const char c : {'"', ',', '\n', '\r', '\0', 'x'}) {
            std::string altered = whole;
            altered[at] = c;
            EXPECT_EQ(refusal(altered).find('\n'), std::string::npos);
        }
}

TEST(Csv, AFileIsReplacedWholeOrNotAtAll) {
    const Folder folder;
    Row row;
    row.ordering = "naive";
    write_csv(folder / "deep/rows.csv", std::span(&row, 1));
    EXPECT_EQ(read_csv(folder / "deep/rows.csv").size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder / "deep/rows.csv.part"));

    std::filesystem::create_directories(folder / "taken");
    EXPECT_THROW(write_csv(folder / "taken", std::span(&row, 1)), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(folder / "taken.part"));
    try {
        read_csv(folder / "absent.csv");
        FAIL();
    } catch (const trace::DataError& error) {
        EXPECT_EQ(std::string(error.what()),
                  (folder / "absent.csv").string() + ": found no such file, expected a file");
    }
    EXPECT_THROW(read_csv(folder.path()), trace::DataError);
}

}  // namespace
}  // namespace regather::results
