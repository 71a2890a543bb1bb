#include "reorder/shared_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "reorder/catalogue.h"
#include "tests/reorder/workload.h"
#include "trace/error.h"

namespace regather::reorder {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

std::string library(std::string_view name) {
    return std::string(PLUGIN_DIRECTORY "/") + std::string(name) + ".so";
}

std::string refusal(const std::string& spec) {
    try {
        const Queries queries = one_per_pixel(2, 2);
        order(*make_ordering(spec), queries.workload());
    } catch (const trace::UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(SharedLibrary, ExampleSortsByHeight) {
    Queries queries = one_per_pixel(6, 1);
    const float heights[] = {3, -1, 0.5f, -7, 3, 1e30f};
    for (std::size_t i = 0; i < 6; ++i) queries.position[i] = {static_cast<float>(i), 9, heights[i]};
    const ParsedOrdering parsed = parse_ordering(library("by_height"));
    EXPECT_EQ(order(*parsed.ordering, queries.workload()).permutation,
              (std::vector<std::uint32_t>{3, 1, 2, 0, 4, 5}));
    EXPECT_EQ(parsed.spec.name, "by-height");
    EXPECT_EQ(parsed.spec.text, "by-height");
    EXPECT_EQ(parsed.spec.tile, std::nullopt);
}

TEST(SharedLibrary, ParametersReachTheLibrary) {
    EXPECT_THAT(refusal(library("by_height") + ":fast"),
                AllOf(HasSubstr("ordering by-height refused with status 1 (parameters \"fast\", 4 queries)"),
                      HasSubstr("by_height.so: ")));
    EXPECT_EQ(parse_ordering(library("by_height") + ":a=/b:c").spec.text, "by-height:a=/b:c");
}

TEST(SharedLibrary, StatesItsCosts) {
    Queries queries = one_per_pixel(2, 2);
    queries.leaf_kd.resize(4);
    const Ordered run = order(*make_ordering(library("plugin_costed")), queries.workload(), 1000);
    EXPECT_EQ(run.permutation, (std::vector<std::uint32_t>{3, 2, 1, 0}));
    EXPECT_EQ(run.cost.keys, 4u);
    EXPECT_EQ(run.cost.buffered_bytes, 1001u);
    EXPECT_EQ(run.cost.stalls, 1u);  // the column came through
    queries.leaf_kd.clear();
    EXPECT_EQ(order(*make_ordering(library("plugin_costed")), queries.workload()).cost.stalls, 0u);
}

TEST(SharedLibrary, RefusesDefectiveOnesInOneLine) {
    EXPECT_THAT(refusal(library("plugin_other_abi")), HasSubstr("plug-in interface 2, this build has 1"));
    EXPECT_THAT(refusal(library("plugin_no_assign_keys")),
                HasSubstr("function regather_assign_keys is missing"));
    EXPECT_THAT(refusal(library("plugin_bad_name")), HasSubstr("regather_ordering_name gives no name"));
    EXPECT_THAT(refusal(library("plugin_refusing")), HasSubstr("ordering test refused with status 7"));
    EXPECT_THAT(refusal("./absent.so"), AllOf(HasSubstr("absent.so: no such file"), Not(HasSubstr("\n"))));
    EXPECT_THAT(refusal("absent.so"), HasSubstr("no such file"));
    EXPECT_THAT(refusal("/"), HasSubstr("no such file"));
}

TEST(SharedLibrary, RefusesDamagedFiles) {
    std::ifstream whole_file(library("by_height"), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(whole_file), {}};
    ASSERT_GT(whole.size(), 1000u);
    const auto path = std::filesystem::path(testing::TempDir()) / "damaged_by_height.so";
    const auto refusal_of = [&](const std::string& bytes) {
        std::ofstream(path, std::ios::binary) << bytes;
        return refusal(path.string());
    };
    EXPECT_EQ(refusal_of(whole), "accepted");
    EXPECT_THAT(refusal_of(""), HasSubstr("not a shared library"));
    EXPECT_THAT(refusal_of("#!/bin/sh\necho this is a script that is longer than the header of a library\n"),
                HasSubstr("not a shared library"));
    for (const std::size_t length : {std::size_t{63}, std::size_t{100}, std::size_t{1000}, whole.size() / 4})
        EXPECT_THAT(refusal_of(whole.substr(0, length)), HasSubstr("shared library")) << length;
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace regather::reorder
