#include "replay/verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "spatial/photon_kd.h"
#include "spatial/recording.h"
#include "tests/scratch.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using testing::HasSubstr;
using trace::Vec3;

/// A small trace, each part of which may be changed before it is written, with checksums that fit.
struct Parts {
    std::vector<trace::Photon> photons;
    std::vector<Vec3> positions, directions;
    std::vector<std::uint32_t> pixels, leaf_kd, walk_bytes;
    std::vector<std::uint8_t> walks;
    std::vector<float> extents;
    trace::TraceInfo info;

    Parts() {
        std::vector<trace::Photon> all(37);
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i].position = {std::fmod(static_cast<float>(i) * 0.37f, 1.0f),
                               std::fmod(static_cast<float>(i) * 0.71f, 1.0f), static_cast<float>(i) * 0.01f};
        photons = spatial::left_balanced(all);
        for (int q = 0; q < 6; ++q) {
            positions.push_back({0.1f * static_cast<float>(q), 0.5f, 0.2f});
            directions.push_back({0, 0, 1});
            pixels.push_back(static_cast<std::uint32_t>(q));
            leaf_kd.push_back(static_cast<std::uint32_t>(q % 3));
        }
        positions[4].x = std::nanf("");
        info.scene = "small";
        info.image_width = 3;
        info.image_height = 2;
        info.k = 5;
        info.queries = positions.size();
        info.photons = photons.size();
        info.parameters["radius"] = 0.15;
        info.counts["leaves_kd"] = 3;
        extents = {0.5f, std::numeric_limits<float>::infinity()};
        search(5, 0.15f);
    }
    void search(std::uint32_t k, float radius) {
        const spatial::Recording found =
            spatial::record_walks(spatial::PhotonKd(photons), positions, k, radius);
        walk_bytes = found.walk_bytes;
        walks = found.walks;
        info.found_photons = found.found_photons;
        info.visited_nodes = found.visited_nodes;
    }
    void write(const std::filesystem::path& folder) const {
        trace::TraceWriter writer(folder, true);
        writer.column("photon").append(std::span<const trace::Photon>(photons));
        writer.column("query_position").append(std::span<const Vec3>(positions));
        writer.column("query_direction").append(std::span<const Vec3>(directions));
        writer.column("query_pixel").append(std::span<const std::uint32_t>(pixels));
        writer.column("query_leaf_kd").append(std::span<const std::uint32_t>(leaf_kd));
        writer.column("query_walk_bytes").append(std::span<const std::uint32_t>(walk_bytes));
        writer.column("walk").append(std::span<const std::uint8_t>(walks));
        writer.column("ray_eye_extent").append(std::span<const float>(extents));
        writer.finish(info);
    }
};

std::string refusal(const std::function<void(Parts&)>& change) {
    const Scratch scratch;
    Parts parts;
    change(parts);
    parts.write(scratch / "t");
    trace::TraceReader trace(scratch / "t");
    try {
        verify(trace);
    } catch (const trace::DataError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Verification, AWholeTraceIsSearchedAgain) {
    const Scratch scratch;
    Parts().write(scratch / "t");
    trace::TraceReader trace(scratch / "t");
    const Verified verified = verify(trace);
    EXPECT_TRUE(verified.searched);
    EXPECT_EQ(verified.queries_nowhere, 1u);
    EXPECT_GT(trace.info().found_photons, 0u);
    EXPECT_LT(trace.info().found_photons, 5u * 5);  // the radius counts
}

TEST(Verification, WhatDoesNotFitIsRefusedByFileAndRow) {
    const struct {
        const char* message;
        std::function<void(Parts&)> change;
    } cases[] = {
        {"photon.npy: row 1: found a photon at no finite place or on the wrong side of a split",
         [](Parts& p) { p.photons[1].position = p.photons[2].position; }},
        {"photon.npy: row 9: found a photon at no",
         [](Parts& p) { p.photons[9].position.z = std::nanf(""); }},
        {"query_pixel.npy: row 3: found 6, expected a pixel below 3 x 2", [](Parts& p) { p.pixels[3] = 6; }},
        {"query_direction.npy: row 2: found 0 0 1.01, expected a vector of length 1",
         [](Parts& p) { p.directions[2].z = 1.01f; }},
        {"query_leaf_kd.npy: row 5: found 3, expected a leaf below 3, as leaves_kd in trace.json says",
         [](Parts& p) { p.leaf_kd[5] = 3; }},
        {"ray_eye_extent.npy: row 0: found -1, expected a length", [](Parts& p) { p.extents[0] = -1; }},
        {"ray_eye_extent.npy: row 1: found nan, expected a length",
         [](Parts& p) { p.extents[1] = std::nanf(""); }},
        {"walk.npy: found ", [](Parts& p) { p.walk_bytes[2] += 1; }},
        {"walk.npy: query 1: found bytes after the walk's end",
         [](Parts& p) {
             p.walk_bytes[1] += 1;
             p.walk_bytes[2] -= 1;
         }},
        {"visited_nodes: found 1, expected", [](Parts& p) { p.info.visited_nodes = 1; }},
        {"found_photons: found 24, expected", [](Parts& p) { p.info.found_photons = 24; }},
        {"walk.npy: row 0: found another walk, expected the one of the search for 5 photons within 0.15",
         [](Parts& p) { p.search(1, 0.15f); }},
        {"found another walk, expected the one of the search for 5 photons within 0.1",
         [](Parts& p) { p.info.parameters["radius"] = 0.1; }},
        {"found another walk, expected the one of the search for 5 photons within inf",
         [](Parts& p) { p.info.parameters["radius"] = nullptr; }},
        {"found another walk", [](Parts& p) { std::swap(p.positions[0], p.positions[5]); }},
        {"found another walk", [](Parts& p) { p.positions[4].x = 0.4f; }},
    };
    for (const auto& [message, change] : cases) EXPECT_THAT(refusal(change), HasSubstr(message));
}

// Every bit of the walks that is changed is noticed, padding included.
TEST(Verification, EachBitOfTheWalksCounts) {
    const std::size_t bytes = Parts().walks.size();
    ASSERT_GT(bytes, 4u);
    for (std::size_t byte = 0; byte < bytes; ++byte)
        for (int bit = 0; bit < 8; ++bit)
            EXPECT_THAT(refusal([&](Parts& p) {
                            p.walks[byte] = static_cast<std::uint8_t>(p.walks[byte] ^ 1 << bit);
                        }),
                        testing::AnyOf(HasSubstr("walk.npy: "), HasSubstr("visited_nodes: ")))
                << byte << ' ' << bit;
}

TEST(Verification, TheRadiusIsThatOfTheMapThatWasSearched) {
    trace::TraceInfo info;
    EXPECT_FALSE(search_radius(info));
    info.parameters["radius"] = 0.5;
    info.parameters["caustic"] = trace::Json::object({{"radius", nullptr}});
    EXPECT_EQ(search_radius(info), 0.5f);
    info.map = "caustic";
    EXPECT_EQ(search_radius(info), std::numeric_limits<float>::infinity());
    info.parameters["caustic"]["radius"] = 0.25;
    EXPECT_EQ(search_radius(info), 0.25f);
    info.parameters["caustic"]["radius"] = "far";
    EXPECT_FALSE(search_radius(info));
}

TEST(Verification, WithoutARadiusTheWalksAreDecodedOnly) {
    const Scratch scratch;
    Parts parts;
    parts.info.parameters = trace::Json::object();
    parts.write(scratch / "t");
    trace::TraceReader trace(scratch / "t");
    EXPECT_FALSE(verify(trace).searched);
    parts.info.found_photons = 6 * 5 + 1;
    parts.write(scratch / "u");
    trace::TraceReader more(scratch / "u");
    EXPECT_THROW(verify(more), trace::DataError);
}

}  // namespace
}  // namespace regather::replay
