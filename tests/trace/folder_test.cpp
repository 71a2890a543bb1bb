#include "trace/folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "tests/scratch.h"

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

TEST(TraceFolder, InconsistentJsonIsRefusedByField) {
    const auto refused_after = [](const char* from, const char* to) {
        const Scratch scratch;
        write_small(scratch / "t");
        replace_in_file(scratch / "t/trace.json", from, to);
        return refusal(scratch / "t");
    };
    EXPECT_NE(
        refused_after("\"regather_trace\": 1", "\"regather_trace\": 2").find("found version 2, expected 1"),
        std::string::npos);
    EXPECT_NE(refused_after("\"queries\": 2", "\"queries\": 3").find("queries: found 3, expected 2"),
              std::string::npos);
    EXPECT_NE(refused_after("\"queries\": 2", "\"queries\": -2").find("not negative"), std::string::npos);
    EXPECT_NE(refused_after("\"photons\": 3", "\"photons\": \"x\"").find("photons: found \"x\""),
              std::string::npos);
    EXPECT_NE(refused_after("\"seed\"", "\"sed\"").find("seed: found nothing"), std::string::npos);
    EXPECT_NE(refused_after("\"walk\"", "\"wlak\"").find("'wlak'"), std::string::npos);
    EXPECT_NE(refused_after("{", "").find("no valid JSON"), std::string::npos);
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
    EXPECT_EQ(TraceReader(scratch / "a").checksum(), TraceReader(scratch / "b").checksum());
    replace_in_file(scratch / "b/trace.json", "\"xxh3_64\": \"", "\"xxh3_64\": \"0");
    EXPECT_NE(refusal(scratch / "b").find("16 hexadecimal digits"), std::string::npos);
}

}  // namespace
}  // namespace regather::trace
