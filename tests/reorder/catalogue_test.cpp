#include "reorder/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trace/error.h"

namespace regather::reorder {
namespace {

using testing::AllOf, testing::HasSubstr;

std::string refusal(std::string_view spec) {
    try {
        make_ordering(spec);
    } catch (const trace::UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Catalogue, HoldsTheOrderingsOfThePaper) {
    std::vector<std::string_view> names;
    for (const Entry& entry : catalogue()) names.push_back(entry.name);
    EXPECT_THAT(names, testing::UnorderedElementsAre("naive", "random", "tiled", "direction-binned",
                                                     "hilbert", "morton", "swizzle", "hashed",
                                                     "direction-binned+hashed", "kd-leaf", "bvh-leaf",
                                                     "origin-direction", "origin-end", "origin-guess"));
}

TEST(Catalogue, SpecTellsEveryParameterAndIsASpecAgain) {
    const std::pair<std::string_view, std::string_view> canonical[] = {
        {"naive", "naive"},
        {"random", "random:seed=1"},
        {"random:seed=18446744073709551615", "random:seed=18446744073709551615"},
        {"tiled", "tiled:tile=16,rows=left-to-right"},
        {"tiled:rows=alternating,tile=8", "tiled:tile=8,rows=alternating"},
        {"direction-binned:bins=8", "direction-binned:tile=16,bins=8,passes=64,state=store"},
        {"hilbert", "hilbert:bits=21"},
        {"hilbert:tile=16", "hilbert:tile=16,bits=16"},
        {"swizzle:tile=32", "swizzle:tile=32,bits=4"},
        {"hashed", "hashed:buckets=512,capacity=64,cells=16"},
        {"direction-binned+hashed",
         "direction-binned+hashed:tile=16,bins=16,passes=256,state=store,buckets=512,capacity=64,cells=16"},
        {"kd-leaf", "kd-leaf"},
    };
    for (const auto& [given, told] : canonical) {
        EXPECT_EQ(parse_ordering(given).spec.text, told);
        EXPECT_EQ(parse_ordering(told).spec.text, told);
    }
}

TEST(Catalogue, SpecTellsTileAndBins) {
    EXPECT_EQ(parse_ordering("hilbert").spec.tile, std::nullopt);
    EXPECT_EQ(parse_ordering("hilbert:tile=32").spec.tile, 32u);
    EXPECT_EQ(parse_ordering("hilbert:tile=32").spec.bins, std::nullopt);
    EXPECT_EQ(parse_ordering("direction-binned+hashed:bins=4").spec.bins, 4u);
    EXPECT_EQ(parse_ordering("direction-binned+hashed:bins=4").spec.tile, 16u);
    EXPECT_EQ(parse_ordering("naive").spec.tile, std::nullopt);
    EXPECT_EQ(parse_ordering("naive").spec.name, "naive");
}

TEST(Catalogue, NamesTheNearestAndAllKnown) {
    EXPECT_THAT(refusal("hilbrt"), AllOf(HasSubstr("unknown ordering \"hilbrt\"; nearest: hilbert;"),
                                         HasSubstr("direction-binned+hashed")));
    EXPECT_THAT(refusal(""), HasSubstr("unknown ordering \"\""));
    for (const std::string& spec :
         {std::string(200000, 'a'), "x\x1b[31m\n" + std::string(5000, 'a'),
          "naive:" + std::string(5000, 'b') + "\x1b=1", "hilbert:" + std::string(5000, 'c') + "\x1b=1",
          "hilbert:bits=\x1b" + std::string(5000, '1'), "tiled:rows=\x1b" + std::string(5000, 'r'),
          std::string(5000, 'l') + "\x1b.so"}) {
        const std::string message = refusal(spec);
        EXPECT_LT(message.size(), 700u) << message;
        EXPECT_EQ(message.find_first_of("\x1b\n"), message.npos) << message;
    }
    EXPECT_EQ(refusal("hilbert:tyle=3"),
              "hilbert: unknown parameter \"tyle\"; nearest: tile; known: tile, bits");
    EXPECT_EQ(refusal("naive:tile=3"), "naive: parameter \"tile=3\" found, it takes none");
    EXPECT_EQ(refusal("tiled:rows=alternate"),
              "tiled: rows is \"alternate\"; nearest: alternating; known: left-to-right, alternating");
}

TEST(Catalogue, RefusesValuesOutOfRange) {
    EXPECT_EQ(refusal("tiled:tile=0"), "tiled: tile is 0, expected 1 to 65536");
    EXPECT_EQ(refusal("hilbert:tile=65537"), "hilbert: tile is 65537, expected 1 to 65536");
    EXPECT_EQ(refusal("hilbert:tile=65536"), "accepted");
    EXPECT_EQ(refusal("tiled:tile=abc"), "tiled: tile is \"abc\", expected a whole number below 2^64");
    EXPECT_EQ(refusal("tiled:tile=-1"), "tiled: tile is \"-1\", expected a whole number below 2^64");
    EXPECT_EQ(refusal("tiled:tile=016"), "tiled: tile is \"016\", expected a whole number below 2^64");
    EXPECT_EQ(refusal("random:seed=0"), "accepted");
    EXPECT_EQ(refusal("tiled:tile=16x"), "tiled: tile is \"16x\", expected a whole number below 2^64");
    EXPECT_EQ(refusal("tiled:tile=4294967312"), "tiled: tile is 4294967312, expected less than 2^32");
    EXPECT_EQ(refusal("tiled:tile=99999999999999999999"),
              "tiled: tile is \"99999999999999999999\", expected a whole number below 2^64");
    EXPECT_EQ(refusal("hilbert:bits=22"), "hilbert: bits is 22, expected 1 to 21");
    EXPECT_EQ(refusal("morton:bits=0"), "morton: bits is 0, expected 1 to 21");
    EXPECT_EQ(refusal("swizzle:bits=9"), "swizzle: bits is 9, expected 1 to 8");
    EXPECT_EQ(refusal("direction-binned:bins=0"), "direction-binned: bins is 0, expected 1 to 4096");
    EXPECT_EQ(refusal("direction-binned:bins=65536"), "direction-binned: bins is 65536, expected 1 to 4096");
    EXPECT_EQ(refusal("direction-binned:bins=2,passes=5"), "direction-binned: passes is 5, expected 1 to 4");
    EXPECT_EQ(refusal("direction-binned:bins=2,passes=0"), "direction-binned: passes is 0, expected 1 to 4");
    EXPECT_EQ(refusal("hashed:capacity=0"), "hashed: capacity is 0, expected 1 to 67108864");
    EXPECT_EQ(refusal("hashed:buckets=65536,capacity=65536"),
              "hashed: buckets x capacity is 4294967296, expected 1 to 67108864");
    EXPECT_EQ(refusal("hashed:cells=0"), "hashed: cells is 0, expected 1 to 2097152");
    EXPECT_EQ(refusal("kd-leaf:tile=0"), "kd-leaf: tile is 0, expected 1 to 65536");
}

TEST(Catalogue, RefusesMalformedSpecs) {
    EXPECT_EQ(refusal("tiled:tile=8,tile=9"), "tiled: parameter tile is given twice");
    EXPECT_EQ(refusal("tiled:tile="), "tiled: parameter tile has no value, expected tile=...");
    EXPECT_EQ(refusal("tiled:tile"), "tiled: parameter tile has no value, expected tile=...");
    EXPECT_EQ(refusal("tiled:tile=8,"), "tiled: nothing after the comma, expected a parameter");
    EXPECT_THAT(refusal("tiled:,tile=8"), HasSubstr("unknown parameter \"\""));
    EXPECT_EQ(refusal("tiled:"), "accepted");
}

}  // namespace
}  // namespace regather::reorder
