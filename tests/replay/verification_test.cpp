#include "replay/verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "spatial/photons/photon_kd.h"
#include "spatial/photons/recording.h"
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
    std::vector<std::uint32_t> pixels, leaf_kd, walk_bytes, candidate_bytes;
    std::vector<std::uint8_t> walks, candidates;
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
            spatial::record_walks(spatial::PhotonKd(photons), positions, k, radius, {.candidates = true});
        walk_bytes = found.walk_bytes;
        walks = found.walks;
        candidate_bytes = found.candidate_bytes;
        candidates = found.candidates;
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
        if (!candidate_bytes.empty())
            writer.column("query_candidate_bytes").append(std::span<const std::uint32_t>(candidate_bytes));
        if (!candidates.empty()) writer.column("candidate").append(std::span<const std::uint8_t>(candidates));
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

TEST(Verification, CandidatesThatDoNotFitAreRefusedByFileAndRow) {
    // The tree has 37 photons in 6 levels: a walk looks at 6 photons or more, in bytes that start with 1.
    const struct {
        const char* message;
        std::function<void(Parts&)> change;
    } cases[] = {
        {"accepted",
         [](Parts& p) {
             p.candidates.clear();
             p.candidate_bytes.clear();
         }},
        {"candidate.npy: found no such column (searches tell it: regather walk TRACE --candidates)",
         [](Parts& p) { p.candidates.clear(); }},
        {"query_candidate_bytes.npy: found no such column", [](Parts& p) { p.candidate_bytes.clear(); }},
        {"query_candidate_bytes.npy: row 2: found 7, expected ", [](Parts& p) { p.candidate_bytes[2] = 7; }},
        {"query_candidate_bytes.npy: row 4: found 1, expected 0, a bit for each of 0 photons looked at",
         [](Parts& p) { p.candidate_bytes[4] = 1; }},
        {"found the end, expected more bytes, as query_candidate_bytes has it",
         [](Parts& p) { p.candidates.pop_back(); }},
        {"found more bytes, expected the end, as query_candidate_bytes has it",
         [](Parts& p) { p.candidates.push_back(0); }},
        {"expected zeros behind ",
         [](Parts& p) {
             for (std::uint8_t& byte : p.candidates) byte |= 1;
         }},
        {"trace.json: found_photons: found ",
         [](Parts& p) { std::fill(p.candidates.begin(), p.candidates.end(), 0); }},
        {"candidate.npy: row 0: found other bits, expected those of the search for 5 photons within 0.15",
         [](Parts& p) { p.candidates[0] = static_cast<std::uint8_t>(p.candidates[0] ^ 0x40); }},
    };
    for (const auto& [message, change] : cases) EXPECT_THAT(refusal(change), HasSubstr(message));
}

TEST(Verification, EachBitOfTheCandidatesCounts) {
    const std::size_t bytes = Parts().candidates.size();
    ASSERT_GT(bytes, 4u);
    for (std::size_t byte = 0; byte < bytes; ++byte)
        for (int bit = 0; bit < 8; ++bit)
            EXPECT_THAT(refusal([&](Parts& p) {
                            p.candidates[byte] = static_cast<std::uint8_t>(p.candidates[byte] ^ 1 << bit);
                        }),
                        testing::AnyOf(HasSubstr("candidate.npy: "), HasSubstr("found_photons: ")))
                << byte << ' ' << bit;
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

std::optional<float> radius_of(const std::function<void(trace::TraceInfo&)>& change) {
    const Scratch scratch;
    Parts parts;
    parts.info.parameters = trace::Json::object();
    change(parts.info);
    parts.write(scratch / "t");
    return search_radius(trace::TraceReader(scratch / "t"));
}

TEST(Verification, TheRadiusIsThatOfTheMapThatWasSearched) {
    const auto both = [](trace::TraceInfo& info) {
        info.parameters["radius"] = 0.5;
        info.parameters["caustic"] = trace::Json::object({{"radius", nullptr}});
    };
    EXPECT_FALSE(radius_of([](trace::TraceInfo&) {}));
    EXPECT_EQ(radius_of(both), 0.5f);
    EXPECT_EQ(radius_of([&](trace::TraceInfo& info) {
                  both(info);
                  info.map = "caustic";
              }),
              std::numeric_limits<float>::infinity());
    EXPECT_EQ(radius_of([&](trace::TraceInfo& info) {
                  both(info);
                  info.map = "caustic";
                  info.parameters["caustic"]["radius"] = 0.25;
              }),
              0.25f);
}

TEST(Verification, ParametersThatContradictTheTraceAreRefused) {
    const struct {
        const char* message;
        std::function<void(Parts&)> change;
    } cases[] = {
        {"trace.json: parameters.radius: found -1, expected",
         [](Parts& p) { p.info.parameters["radius"] = -1; }},
        {"trace.json: parameters.radius: found 0, expected",
         [](Parts& p) { p.info.parameters["radius"] = 0; }},
        {"parameters.radius: found \"abc\", expected", [](Parts& p) { p.info.parameters["radius"] = "abc"; }},
        {"parameters.radius: found true, expected", [](Parts& p) { p.info.parameters["radius"] = true; }},
        {"parameters.radius: found nothing, expected",
         [](Parts& p) {
             p.info.parameters = trace::Json::object({{"scene_checksum", "2d46244c72294a8a"}});
         }},
        {"parameters.radius: found nothing, expected",
         [](Parts& p) {
             p.info.parameters = trace::Json::object();
             p.info.counts["photon_paths"] = 7;
         }},
        {"parameters.caustic.radius: found nothing, expected", [](Parts& p) { p.info.map = "caustic"; }},
        {"parameters.k: found 6, expected 5 as k", [](Parts& p) { p.info.parameters["k"] = 6; }},
        {"parameters.caustic.k: found 6, expected 5 as k",
         [](Parts& p) {
             p.info.map = "caustic";
             p.info.parameters["k"] = 7;
             p.info.parameters["caustic"] = trace::Json::object({{"k", 6}, {"radius", 0.15}});
         }},
        {"parameters.width: found 4, expected 3 as image_width",
         [](Parts& p) { p.info.parameters["width"] = 4; }},
        {"parameters.height: found 3, expected 2 as image_height",
         [](Parts& p) { p.info.parameters["height"] = 3; }},
        {"parameters.seed: found 1, expected 0 as seed", [](Parts& p) { p.info.parameters["seed"] = 1; }},
        {"counts.eye_rays: found 3, expected 2 as the rows of ray_eye_extent",
         [](Parts& p) { p.info.counts["eye_rays"] = 3; }},
        {"counts.leaves_kd: found nothing, expected how many leaves query_leaf_kd counts",
         [](Parts& p) {
             p.info.counts = trace::Json::object();
             p.info.parameters["scene_checksum"] = "2d46244c72294a8a";
         }},
        {"counts.leaves_kd: found \"three\", expected",
         [](Parts& p) { p.info.counts["leaves_kd"] = "three"; }},
    };
    for (const auto& [message, change] : cases) EXPECT_THAT(refusal(change), HasSubstr(message));
    // The caustic map has its own k and radius, beside which the other map's do not count.
    EXPECT_EQ(refusal([](Parts& p) {
                  p.info.map = "caustic";
                  p.info.parameters["k"] = 7;
                  p.info.parameters["radius"] = 0.7;
                  p.info.parameters["caustic"] = trace::Json::object({{"k", 5}, {"radius", 0.15}});
              }),
              "accepted");
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
