#include "capture/reference/reference.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "capture/capture.h"
#include "tests/capture/images/picture.h"
#include "tests/capture/small_scenes.h"
#include "trace/error.h"

namespace regather::capture {
namespace {

namespace fs = std::filesystem;

struct ReferenceTest : testing::Test {
    ReferenceTest() { fs::create_directories(folder); }
    ~ReferenceTest() override { fs::remove_all(folder); }

    const fs::path folder = fs::temp_directory_path() / fmt::format("regather-reference-{}", ::getpid());
    const Scene scene = closed_box(0.5);
    const RayCaster caster{scene};
    const LightSampler lights{scene};
    const PathTracer tracer{scene, caster, lights, {.width = 12, .height = 9, .seed = 3}};
    const ReferenceKey key{"closed", checksum(scene), 12, 9, 3};

    static std::string bytes(const fs::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void expect_damaged(const std::string& words) {
        try {
            load_reference(folder);
            ADD_FAILURE() << "loaded; expected: " << words;
        } catch (const trace::DataError& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    void replace_in_state(const std::string& from, const std::string& to) {
        std::string text = bytes(folder / "reference.json");
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        std::ofstream(folder / "reference.json") << text;
    }
};

TEST_F(ReferenceTest, GoesOnWhereItWasSavedToTheLastBit) {
    Reference once(key);
    once.add(tracer, 8);
    save(once, folder);
    const std::string whole = bytes(folder / "moments-8.npy");
    fs::remove_all(folder);

    Reference first = resume_reference(folder, key);
    EXPECT_EQ(first.samples, 0u);
    first.add(tracer, 3);
    save(first, folder);
    Reference second = resume_reference(folder, key);
    EXPECT_EQ(second.samples, 3u);
    EXPECT_EQ(second.seconds, first.seconds);
    second.add(tracer, 5);
    save(second, folder);
    EXPECT_EQ(bytes(folder / "moments-8.npy"), whole);
    EXPECT_FALSE(fs::exists(folder / "moments-3.npy"));

    const Reference loaded = load_reference(folder);
    EXPECT_EQ(loaded.pixels, once.pixels);
    EXPECT_EQ(loaded.counts, once.counts);
    EXPECT_EQ(loaded.samples, 8u);
    EXPECT_EQ(loaded.key.scene_checksum, key.scene_checksum);
    EXPECT_EQ(loaded.mean().pixels, once.mean().pixels);
    EXPECT_EQ(loaded.variance().pixels, once.variance().pixels);
}

/// As if the process had been killed after each of the steps of a save.
TEST_F(ReferenceTest, AHalfWrittenSaveLeavesTheOneBefore) {
    Reference reference(key);
    reference.add(tracer, 2);
    save(reference, folder);
    std::ofstream(folder / "moments-5.npy.partial") << "half";
    EXPECT_EQ(load_reference(folder).samples, 2u);
    std::ofstream(folder / "moments-5.npy") << "whole, but not named";
    std::ofstream(folder / "reference.json.partial") << "{";
    EXPECT_EQ(load_reference(folder).pixels, reference.pixels);
    save(reference, folder);  // and the next one cleans up
    EXPECT_FALSE(fs::exists(folder / "moments-5.npy"));
    EXPECT_FALSE(fs::exists(folder / "moments-5.npy.partial"));
    EXPECT_FALSE(fs::exists(folder / "reference.json.partial"));
    EXPECT_EQ(load_reference(folder).samples, 2u);
}

TEST_F(ReferenceTest, OfAnotherSceneSizeOrSeedIsRefused) {
    Reference reference(key);
    reference.add(tracer, 1);
    save(reference, folder);
    ReferenceKey scene_differs = key, size_differs = key, seed_differs = key;
    scene_differs.scene_checksum = "0123456789abcdef";
    size_differs.width = 13;
    seed_differs.seed = 4;
    EXPECT_THROW(resume_reference(folder, scene_differs), trace::UsageError);
    EXPECT_THROW(resume_reference(folder, size_differs), trace::UsageError);
    EXPECT_THROW(resume_reference(folder, seed_differs), trace::UsageError);
    EXPECT_EQ(resume_reference(folder, key).samples, 1u);
    Scene brighter = scene;
    brighter.lights[0].radiance.x *= 2;
    EXPECT_NE(checksum(brighter), key.scene_checksum);
}

TEST_F(ReferenceTest, DamageIsNamed) {
    expect_damaged("reference.json: found no such file");
    Reference reference(key);
    reference.add(tracer, 2);
    save(reference, folder);
    replace_in_state("\"samples\": 2", "\"samples\": -2");
    expect_damaged("samples: found -2, expected a whole number");
    save(reference, folder);
    replace_in_state("\"image_width\": 12", "\"image_width\": 4000000000");
    expect_damaged("image_width: found 4000000000, expected a whole number from 1 to 32768");
    save(reference, folder);
    replace_in_state("\"image_width\": 12", "\"image_width\": 13");
    expect_damaged("found 108 rows, expected 13 x 9 pixels");
    save(reference, folder);
    replace_in_state("moments-2.npy", "../moments-2");
    expect_damaged("moments: found \"../moments-2\"");
    save(reference, folder);
    replace_in_state("\"seconds\"", "\"hours\"");
    expect_damaged("hours: found unknown key \"hours\"");
    save(reference, folder);
    replace_in_state("\"reference_version\": 1", "\"reference_version\": 2");
    expect_damaged("reference_version: found 2, expected 1");
    save(reference, folder);
    std::ofstream(folder / "reference.json") << "[1, 2";
    expect_damaged("reference.json: line 1, column 6: found the end of the file");
    save(reference, folder);
    std::fstream file(folder / "moments-2.npy", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-5, std::ios::end);
    file.put('!');
    file.close();
    expect_damaged("altered or damaged");
    fs::resize_file(folder / "moments-2.npy", 1000);
    EXPECT_THROW(load_reference(folder), trace::DataError);
}

TEST_F(ReferenceTest, SamplesAreHeldAgainstTheMoments) {
    Reference reference(key);
    reference.add(tracer, 2);
    save(reference, folder);
    replace_in_state("\"samples\": 2", "\"samples\": 3");
    expect_damaged("moments: found \"moments-2.npy\", expected \"moments-3.npy\"");
    save(reference, folder);
    replace_in_state("\"paths\": 216", "\"paths\": 215");
    expect_damaged("paths: found 215, expected 2 samples of each of 108 pixels");
    fs::remove_all(folder);
    fs::create_directories(folder / "reference.json");
    expect_damaged("reference.json: found a folder");
}

/// Of two samples that are not negative, with mean m, the squares are 2 m^2 at most: 0 and 2 m.
TEST_F(ReferenceTest, MomentsThatNoSamplesHaveAreRefused) {
    Reference reference(key);
    reference.add(tracer, 2);
    Moments& pixel = reference.pixels[5];
    const auto save_with = [&](double mean, double squares) {
        pixel.mean[1] = mean;
        pixel.squares[1] = squares;
        save(reference, folder);
    };
    save_with(3, 18);
    EXPECT_EQ(load_reference(folder).pixels[5].mean[1], 3);
    const std::string where = "moments-2.npy: row 5, channel 1: found a mean of ";
    save_with(3, 18.01);
    expect_damaged(where + "3 and squares of 18.01, expected those of 2 samples that are not negative");
    for (const auto& [mean, squares] : {std::pair{-3.0, 1.0},
                                        {std::nan(""), 1.0},
                                        {3.0, std::nan("")},
                                        {3.0, -1.0},
                                        {std::numeric_limits<double>::infinity(), 1.0}}) {
        save_with(mean, squares);
        expect_damaged(where);
    }
}

/// The spread of the mean over many seeds is what one reference says of itself.
TEST_F(ReferenceTest, TellsItsOwnError) {
    constexpr int seeds = 200;
    constexpr std::uint32_t samples = 8;
    std::vector<Moments> over_seeds(key.width * key.height);
    double told = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const PathTracer other(scene, caster, lights,
                               {.width = 12, .height = 9, .seed = static_cast<std::uint64_t>(seed)});
        Reference reference({"closed", key.scene_checksum, 12, 9, static_cast<std::uint64_t>(seed)});
        reference.add(other, samples);
        told += reference.mean_variance() / seeds;
        for (std::size_t i = 0; i < over_seeds.size(); ++i)
            over_seeds[i].add(reference.pixels[i].mean, static_cast<std::uint64_t>(seed) + 1);
    }
    double found = 0;
    for (const Moments& pixel : over_seeds)
        for (std::size_t c = 0; c < 3; ++c)
            found += pixel.variance(c, seeds) * seeds / (3.0 * key.width * key.height);
    EXPECT_NEAR(found / told, 1, 0.08);
}

/// Two samples 0 and 2 d: mean d, variance of the mean d^2.
TEST_F(ReferenceTest, SummariesAreThoseOfThreePixels) {
    Reference reference({"three", "", 3, 1, 1});
    reference.samples = 2;
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = std::array{1.0, 3.0, 8.0}[i];
        reference.pixels[i].add({0, 0, 0}, 1);
        reference.pixels[i].add({2 * d, 2 * d, 2 * d}, 2);
    }
    EXPECT_DOUBLE_EQ(reference.mean_radiance(), 4);
    EXPECT_DOUBLE_EQ(reference.mean_variance(), (1.0 + 9 + 64) / 3);
    EXPECT_DOUBLE_EQ(reference.median_variance(), 9);
    EXPECT_EQ(reference.variance().pixels[2].y, 64);
}

TEST_F(ReferenceTest, ImagesAreMeanAndVariance) {
    Reference reference(key);
    reference.add(tracer, 4);
    write_images(reference, folder);
    EXPECT_EQ(read_exr(folder / "reference.exr").pixels, reference.mean().pixels);
    EXPECT_EQ(read_exr(folder / "variance.exr").pixels, reference.variance().pixels);
    EXPECT_TRUE(fs::exists(folder / "reference.png"));
    EXPECT_GT(reference.mean_radiance(), 0);
}

}  // namespace
}  // namespace regather::capture
