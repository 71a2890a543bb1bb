// Ladders: the built-in ones vary one thing each, and files are read or refused.
#include "study/ladder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "study/convergence.h"
#include "trace/error.h"

namespace regather::study {
namespace {

TEST(DefaultLadder, HoldsWhatItDoesNotVary) {
    std::map<std::string, std::set<std::uint32_t>> photons, k;
    for (const Setting& setting : default_ladder(2, false)) {
        photons[setting.ladder].insert(setting.photons);
        k[setting.ladder].insert(setting.k);
        EXPECT_EQ(setting.caustic_photons, 0u);
        if (setting.ladder == "direct-both") {
            EXPECT_NEAR(setting.k, std::sqrt(setting.photons), 1);
        }
        if (setting.ladder == "radius") {
            EXPECT_LE(setting.radius, 0.2);
        }
    }
    EXPECT_EQ(k["direct-photons"].size(), 1u);
    EXPECT_EQ(photons["direct-photons"].size(), 8u);
    EXPECT_EQ(photons["direct-k"].size(), 1u);
    EXPECT_EQ(k["direct-k"].size(), 8u);
    EXPECT_EQ(photons.count("caustic-photons"), 0u);
}

TEST(ParseLadder, EmptyCellsTakeTheDefaults) {
    const auto found = parse_ladder("ladder,mode,k,radius\nmine,direct,7,\nmine,,,0.5\n", "l.csv");
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].mode, capture::Visualisation::direct);
    EXPECT_EQ(found[0].k, 7u);
    EXPECT_TRUE(std::isinf(found[0].radius));
    EXPECT_EQ(found[1].mode, capture::Visualisation::final_gather);
    EXPECT_EQ(found[1].k, Setting().k);
    EXPECT_EQ(found[1].radius, 0.5);
}

TEST(ParseLadder, SpecsHaveAllTheirParametersAndPhotonsAreHeld) {
    const auto found = parse_ladder(
        "ladder,sampling,irradiance_cache,photon_seed,precompute_every,reverse_pixels\n"
        "mine,brdf,bounded,7,3,\nmine,cosine,,,,64\n",
        "l.csv");
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].sampling, "");  // the default
    EXPECT_EQ(found[0].irradiance_cache.substr(0, 8), "bounded:");
    EXPECT_EQ(found[0].photon_seed, 7u);
    EXPECT_EQ(found[1].irradiance_cache, "");
    EXPECT_FALSE(found[1].photon_seed);
    ConvergenceConfig config;
    const capture::CaptureConfig held = capture_config(found[0], config, 3);
    EXPECT_EQ(held.photon.seed, 7u);
    EXPECT_EQ(held.pixels.seed, 3u);
    EXPECT_EQ(held.precompute_every, 3u);
    EXPECT_EQ(held.reverse_pixels, 0u);
    EXPECT_EQ(capture_config(found[1], config, 3).reverse_pixels, 64u);
    EXPECT_EQ(held.pixels.irradiance_cache, found[0].irradiance_cache);
    EXPECT_EQ(capture_config(found[1], config, 3).photon.seed, 3u);
}

TEST(ParseLadder, RefusesWhatNoRendererCanDo) {
    for (const char* text :
         {"ladder,k\nmine,0\n", "ladder,mode\nmine,fast\n", "ladder\n", "k\n5\n", "ladder,radius\nmine,0\n",
          "ladder,k\n,5\n", "ladder\n../mine\n", "ladder,irradiance_cache\nmine,none\n",
          "ladder,mode,irradiance_cache\nmine,direct,bounded\n",
          "ladder,gather_rays,precompute_every\nmine,0,1\n",
          "ladder,precompute_every,reverse_pixels\nmine,1,64\n", "ladder\n\"mi\nne\"\n"})
        EXPECT_THROW(parse_ladder(text, "l.csv"), trace::DataError) << text;
}

TEST(ParseLadder, ShowsAModeOfTwoLinesInOne) {
    try {
        parse_ladder("ladder,mode\nmine,\"fa\nst\"\n", "l.csv");
        ADD_FAILURE() << "taken";
    } catch (const trace::DataError& error) {
        EXPECT_STREQ(error.what(),
                     "l.csv: row 1, column mode: found \"fa\\nst\", expected final-gather or direct");
    }
}

}  // namespace
}  // namespace regather::study
