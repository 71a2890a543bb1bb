// Gathers against the estimate of each query by itself: what comes from where, and goes to whom.
#include "capture/gather_pass.h"

#include <gtest/gtest.h>

#include "capture/sampler.h"

namespace regather::capture {
namespace {

TEST(GatherPass, EachQueryIsTheEstimateTowardsWhereItsRayCameFromWhateverTheOrder) {
    Scene scene;
    scene.materials = {{.name = "white", .diffuse = {1, 1, 1}},
                       {.name = "lacquer",
                        .kind = scenes::MaterialKind::glossy,
                        .diffuse = {0.2f, 0.3f, 0.4f},
                        .specular = {0.5f, 0.4f, 0.3f},
                        .exponent = 30}};
    scene.triangle_material = {0, 1};
    std::vector<trace::Photon> photons(500);
    Sampler sampler(3, Stream::photon, 0);
    for (trace::Photon& photon : photons) {
        photon.position = {sampler.uniform(), sampler.uniform(), 0};
        trace::encode_power({1, 2, 3}, photon.power);
        trace::encode_direction(trace::normalize(Vec3{0.6f, 0.1f, -0.8f}), photon);
        trace::encode_normal({0, 0, 1}, photon);
    }
    const std::vector<trace::Photon> heap = spatial::left_balanced(photons);
    const spatial::PhotonKd tree(heap);
    Queries queries;
    for (std::uint32_t q = 0; q < 5; ++q) {
        queries.position.push_back({0.1f + 0.2f * static_cast<float>(q), 0.5f, 0});
        queries.direction.push_back(trace::normalize(Vec3{q % 2 == 0 ? -0.6f : 0.6f, 0, -0.8f}));
        queries.normal.push_back({0, 0, 1});
        queries.triangle.push_back(q < 2 ? 0 : 1);
    }
    const GatherConfig config{.k = 20, .radius = 0.3f};
    for (const std::vector<std::uint32_t>& order :
         {std::vector<std::uint32_t>{0, 1, 2, 3, 4}, {3, 0, 4, 2, 1}}) {
        Gathered gathered;
        gather(scene, tree, queries, order, config, gathered);
        for (std::size_t q = 0; q < 5; ++q) {
            spatial::NearestSet found(20, 0.3f);
            spatial::nearest(tree, queries.position[q], found);
            const Material& material = scene.materials[q < 2 ? 0 : 1];
            EXPECT_EQ(gathered.radiance[q],
                      reflected_radiance(tree, found, {&material, {0, 0, 1}, queries.direction[q] * -1.0f},
                                         Filter::none, true))
                << q;
        }
        EXPECT_GT(gathered.radiance[2].x, 0);
        EXPECT_NE(gathered.radiance[2],
                  gathered.radiance[3]);  // the light comes from -x: one sees its reflection
        EXPECT_EQ(gathered.found_photons, 100u);
    }
}

}  // namespace
}  // namespace regather::capture
