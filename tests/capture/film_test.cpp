// Two pixels of three eye rays, added up by hand.
#include "capture/film.h"

#include <gtest/gtest.h>

namespace regather::capture {
namespace {

LayeredRadiance seen(float direct, float specular = 0) {
    LayeredRadiance radiance{};
    radiance[static_cast<std::size_t>(Layer::direct)] = {direct, direct, direct};
    radiance[static_cast<std::size_t>(Layer::specular)] = {specular, specular, specular};
    return radiance;
}

TEST(Film, AddsUpEyeRaysLayersAndGathersByPixel) {
    PixelWork work;
    // Luminances 1, 2, 6: mean 3, squares 4 + 1 + 9 = 14. Then 5, 5 + 0.5 x 6, 5: mean 6, squares 1 + 4 + 1
    // = 6.
    work.radiance = {seen(1), seen(0.5f, 1.5f), seen(6), seen(5), seen(5), seen(5)};
    work.queries.position = {{}};
    work.queries.weight = {{0.5f, 0.5f, 0.5f}};
    work.queries.pixel = {1};
    work.queries.sample = {1};
    work.queries.layer = {Layer::indirect};
    Gathered gathered;
    gathered.radiance = {{6, 6, 6}};
    Film film(2, 1, 3);
    film.add(work, gathered, {});
    const Layers layers = film.layers();
    EXPECT_FLOAT_EQ(film.image().pixels[0].x, 3);
    EXPECT_FLOAT_EQ(film.image().pixels[1].y, 6);
    EXPECT_FLOAT_EQ(layers[Layer::direct].pixels[0].z, 2.5f);
    EXPECT_FLOAT_EQ(layers[Layer::specular].pixels[0].x, 0.5f);
    EXPECT_FLOAT_EQ(layers[Layer::indirect].pixels[1].x, 1);
    EXPECT_FLOAT_EQ(layers[Layer::indirect].pixels[0].x, 0);
    EXPECT_EQ(layers.query_count, (std::vector<std::uint32_t>{0, 1}));
    // Of the mean: the squares over n (n - 1).
    EXPECT_FLOAT_EQ(layers.variance[0], 14.0f / 6);
    EXPECT_FLOAT_EQ(layers.variance[1], 6.0f / 6);
}

}  // namespace
}  // namespace regather::capture
