#include "trace/folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "tests/column.h"
#include "tests/scratch.h"
#include "trace/file.h"

namespace regather::trace {
namespace {

TraceInfo write_small(const std::filesystem::path& folder) {
    TraceWriter writer(folder, false);
    const std::vector<Photon> photons(3);
    const std::vector<Vec3> positions{{1, 2, 3}, {4, 5, 6}};
    const std::vector<std::uint32_t> pixels{0, 1}, lengths{1, 2};
    const std::vector<std::uint8_t> walks{7, 8, 9};
    writer.column("photon").append(std::span<const Photon>(photons));
    writer.column("query_position").append(std::span<const Vec3>(positions));
    writer.column("query_pixel").append(std::span<const std::uint32_t>(pixels));
    writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(lengths));
    writer.column("walk").append(std::span<const std::uint8_t>(walks));
    TraceInfo info;
    info.scene = "small";
    info.image_width = 2;
    info.image_height = 1;
    info.k = 7;
    info.queries = 2;
    info.photons = 3;
    info.left_out.push_back({"query_direction", "nobody asked"});
    writer.finish(info);
    return info;
}

std::string refusal(const std::filesystem::path& folder, const std::function<void(TraceReader&)>& use = {}) {
    try {
        TraceReader reader(folder);
        if (use) use(reader);
    } catch (const DataError& error) {
        return error.what();
    }
    return "accepted";
}

void replace_in_file(const std::filesystem::path& path, const std::string& from, const std::string& to) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    std::string all = text.str();
    const std::size_t at = all.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(path) << all.replace(at, from.size(), to);
}

TEST(TraceFolder, AFinishedTraceIsReadBack) {
    const Scratch scratch;
    write_small(scratch / "t");
    TraceReader reader(scratch / "t");
    EXPECT_EQ(reader.info().scene, "small");
    EXPECT_EQ(reader.column<Vec3>("query_position")[1], (Vec3{4, 5, 6}));
    EXPECT_EQ(reader.column<std::uint8_t>("walk")[2], 9);
    EXPECT_NO_THROW(reader.verify_all());
    EXPECT_FALSE(reader.has("query_direction"));
}

TEST(TraceFolder, WithoutTraceJsonItIsAnUnfinishedCapture) {
    const Scratch scratch;
    write_small(scratch / "t");
    std::filesystem::remove(scratch / "t/trace.json");
    EXPECT_NE(refusal(scratch / "t").find("expected a finished trace"), std::string::npos);
    EXPECT_NE(refusal(scratch / "nowhere").find("no such folder"), std::string::npos);
}

TEST(TraceFolder, NoStateBeforeTheLastStepOfWritingIsATrace) {
    const Scratch scratch;
    {
        TraceWriter writer(scratch / "t", false);
        EXPECT_NE(refusal(scratch / "t"), "accepted");
        const std::vector<Photon> photons(3);
        writer.column("photon").append(std::span<const Photon>(photons));
        EXPECT_NE(refusal(scratch / "t"), "accepted");
    }
    EXPECT_NE(refusal(scratch / "t"), "accepted");
}

TEST(TraceFolder, OneChangedByteIsRefusedByTheColumnsName) {
    const Scratch scratch;
    write_small(scratch / "t");
    const auto path = scratch / "t/walk.npy";
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-1, std::ios::end);
    file.put('\x0a');
    file.close();
    const std::string message =
        refusal(scratch / "t", [](TraceReader& r) { r.column<std::uint8_t>("walk"); });
    EXPECT_NE(message.find("walk.npy: found checksum"), std::string::npos) << message;
    EXPECT_EQ(refusal(scratch / "t", [](TraceReader& r) { r.column<Vec3>("query_position"); }), "accepted");
}

TEST(TraceFolder, AColumnOfAnotherLengthIsRefused) {
    const Scratch scratch;
    write_small(scratch / "t");
    write_column<std::uint8_t>(scratch / "t/walk.npy", std::vector<std::uint8_t>{7, 8});
    const std::string message =
        refusal(scratch / "t", [](TraceReader& r) { r.column<std::uint8_t>("walk"); });
    EXPECT_NE(message.find("found 2 rows, expected 3"), std::string::npos) << message;
}

TEST(TraceFolder, AColumnThatWasLeftOutIsRefusedWithTheReason) {
    const Scratch scratch;
    write_small(scratch / "t");
    const std::string message =
        refusal(scratch / "t", [](TraceReader& r) { r.column<Vec3>("query_direction"); });
    EXPECT_NE(message.find("nobody asked"), std::string::npos) << message;
}

TEST(TraceFolder, WithoutSearchesForPhotonsThereNeedBeNone) {
    const Scratch scratch;
    const auto write = [&](const char* name, std::uint32_t k, std::uint64_t photons) {
        TraceWriter writer(scratch / name, false);
        writer.column("query_position").append(std::span<const Vec3>());
        writer.column("query_pixel").append(std::span<const std::uint32_t>());
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>());
        writer.column("walk").append(std::span<const std::uint8_t>());
        TraceInfo info;
        info.image_width = info.image_height = 1;
        info.k = k;
        info.photons = photons;
        writer.finish(info);
        return scratch / name;
    };
    EXPECT_EQ(TraceReader(write("none", 0, 0)).info().k, 0u);
    EXPECT_NE(refusal(write("searched", 1, 0)).find("found no photon, expected every required column"),
              std::string::npos);
    EXPECT_NE(refusal(write("counted", 0, 3)).find("photons: found 3, expected 0 as the rows of photon"),
              std::string::npos);
}

TEST(TraceFolder, InconsistentJsonIsRefusedByField) {
    const auto refused = [](const char* from, const char* to, const std::string& words) {
        const Scratch scratch;
        write_small(scratch / "t");
        replace_in_file(scratch / "t/trace.json", from, to);
        const std::string message = refusal(scratch / "t");
        EXPECT_NE(message.find(words), std::string::npos) << message;
        EXPECT_NE(message.find("trace.json: line "), std::string::npos) << message;
    };
    for (const char* const other : {"0", "1", "3", "-1", "2.5", "\"2\"", "18446744073709551618"})
        refused("\"regather_trace\": 2", (std::string("\"regather_trace\": ") + other).c_str(),
                ", expected 2; capture the scene again");
    refused("\"regather_trace\": 2,", "", "regather_trace: found nothing");
    refused("\"queries\": 2", "\"queries\": 3", "queries: found 3, expected 2 as the rows of query_position");
    refused("\"photons\": 3", "\"photons\": 2", "photons: found 2, expected 3 as the rows of photon");
    refused("\"queries\": 2", "\"queries\": -2",
            "queries: found -2, expected a whole number that is not negative");
    refused("\"photons\": 3", "\"photons\": \"x\"", "photons: found \"x\"");
    refused("\"seed\"", "\"sed\"", "sed: found unknown key \"sed\", expected \"seed\"");
    refused("\"walk\"", "\"wlak\"", "columns.wlak: found unknown column \"wlak\", expected \"walk\"");
    refused("{", "", "column 19: found ':', expected the end of the file");
    refused("\"image_width\": 2", "\"image_width\": 0",
            "image_width: found 0, expected a whole number of pixels from 1");
    refused("\"image_height\": 1", "\"image_height\": 4294967296",
            "image_height: found 4294967296, expected");
    refused("\"k\": 7", "\"k\": 0", "k: found 0, expected a whole number from 1 up");
    refused("\"global\"", "\"local\"",
            "map: found \"local\", expected \"global\", \"caustic\", \"guide\", "
            "\"precompute\", \"precomputed\" or \"hits\"");
    refused("\"structure_version\": 1", "\"structure_version\": 0",
            "structure_version: found 0, expected a whole number from 1 up");
    refused("\"uint8\"", "\"uint16\"", "columns.walk.type: found \"uint16\", expected \"uint8\"");
    refused("\"what\"", "\"which\"", "left_out[0].which: found unknown key \"which\", expected \"what\"");
}

TEST(TraceFolder, ColumnsOfOneGroupHaveTheSameNumberOfRows) {
    const Scratch scratch;
    write_small(scratch / "t");
    const ColumnDigest three =
        write_column<std::uint32_t>(scratch / "t/query_pixel.npy", std::vector<std::uint32_t>{0, 1, 1});
    std::string json = read_file(scratch / "t/trace.json");
    json = std::regex_replace(json, std::regex("(\"query_pixel\": \\{\\s*\"rows\": )2"), "$013");
    ASSERT_NE(json.find("\"rows\": 3", json.find("query_pixel")), std::string::npos);
    ASSERT_EQ(three.rows, 3u);
    write_whole(scratch / "t/trace.json", json);
    const std::string message = refusal(scratch / "t");
    EXPECT_NE(message.find("columns.query_position.rows: found 2, expected 3 as in query_pixel"),
              std::string::npos)
        << message;
}

TEST(TraceFolder, AFinishedTraceIsNotOverwrittenUnasked) {
    const Scratch scratch;
    write_small(scratch / "t");
    EXPECT_THROW(TraceWriter(scratch / "t", false), UsageError);
    EXPECT_EQ(refusal(scratch / "t"), "accepted");
    const TraceWriter writer(scratch / "t", true);
    EXPECT_NE(refusal(scratch / "t"), "accepted");
}

TEST(TraceFolder, ForeignFilesAreNotTouched) {
    const Scratch scratch;
    std::ofstream(scratch / "thesis.tex") << "x";
    EXPECT_THROW(TraceWriter(scratch.path(), true), UsageError);
    EXPECT_TRUE(std::filesystem::exists(scratch / "thesis.tex"));
}

TEST(TraceFolder, TheChecksumOfATraceChangesWithAnyColumn) {
    const Scratch scratch;
    write_small(scratch / "a");
    write_small(scratch / "b");
    const std::string checksum = TraceReader(scratch / "a").checksum();
    EXPECT_EQ(TraceReader(scratch / "b").checksum(), checksum);
    std::set<std::string> all{checksum};
    for (const char* const name : {"photon", "query_position", "query_pixel", "query_walk_bytes", "walk"}) {
        // The column's last byte is another one, and trace.json has the checksum that belongs to it.
        write_small(scratch / name);
        const std::filesystem::path column = scratch / name / (std::string(name) + ".npy");
        std::string bytes = read_file(column);
        bytes.back() = static_cast<char>(bytes.back() ^ 1);
        write_whole(column, bytes);
        const std::string message = refusal(scratch / name, [](TraceReader& reader) { reader.verify_all(); });
        std::smatch found;
        ASSERT_TRUE(std::regex_search(message, found, std::regex("found checksum (\\w+), expected (\\w+)")))
            << message;
        replace_in_file(scratch / name / "trace.json", found[2], found[1]);
        EXPECT_EQ(refusal(scratch / name, [](TraceReader& reader) { reader.verify_all(); }), "accepted");
        all.insert(TraceReader(scratch / name).checksum());
    }
    EXPECT_EQ(all.size(), 6u);
}

TEST(TraceFolder, ChecksumsAreSixteenHexadecimalDigits) {
    const Scratch scratch;
    write_small(scratch / "t");
    replace_in_file(scratch / "t/trace.json", "\"xxh3_64\": \"", "\"xxh3_64\": \"0");
    EXPECT_NE(refusal(scratch / "t").find("16 hexadecimal digits"), std::string::npos);
}

TEST(TraceFolder, OneWriterAtATime) {
    const Scratch scratch;
    {
        const TraceWriter first(scratch / "t", false);
        try {
            const TraceWriter second(scratch / "t", true);
            FAIL() << "two writers";
        } catch (const UsageError& error) {
            EXPECT_NE(std::string(error.what()).find("t: another process is writing into this folder"),
                      std::string::npos);
        }
        const TraceWriter elsewhere(scratch / "u", false);
    }
    write_small(scratch / "t");  // nothing is left of the lock
    EXPECT_EQ(refusal(scratch / "t"), "accepted");
}

TEST(TraceFolder, AHeldFolderIsFreeWhenItsProcessIsKilled) {
    const Scratch scratch;
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const FolderLock lock(scratch / "t");
        if (::write(ready[1], "x", 1) != 1) ::_exit(1);
        ::pause();
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_THROW(FolderLock(scratch / "t"), UsageError);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_NO_THROW(FolderLock(scratch / "t"));
    EXPECT_TRUE(std::filesystem::is_empty(scratch / "t"));
}

}  // namespace
}  // namespace regather::trace
