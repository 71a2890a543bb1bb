// What this project is about, on a scene that is captured here: a space-filling curve moves fewer bytes than
// the order of the pixels, and that fewer than no order.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cachesim/cache_list.h"
#include "capture/capture.h"
#include "experiment/measurement.h"
#include "scenes/loader.h"
#include "tests/scratch.h"

namespace regather::experiment {
namespace {

TEST(Locality, HilbertMovesFewerBytesThanNaiveAndNaiveFewerThanRandom) {
    const Scratch scratch;
    capture::CaptureConfig config;
    config.pixels = {
        .width = 48, .height = 40, .gather_rays = 16, .shadow_rays = 1, .max_specular = 16, .seed = 2};
    config.photon = {.photons = 20'000, .seed = 2};
    config.gather.k = 50;
    trace::TraceWriter writer(scratch / "trace", false);
    capture::Captured captured = capture::capture(scenes::load_scene("room"), config, {&writer});
    writer.finish(captured.info);

    trace::TraceReader trace(scratch / "trace");
    const std::vector<std::string> specs{"hilbert", "hilbert:tile=16", "naive", "random"};
    const Orderings orderings = parse_orderings(specs);
    const auto nobody = [](std::uint64_t) {};
    Measurement measurement(trace, orderings.reads, 1 << 20);
    const auto caches = cachesim::parse_caches("16K:128:8");
    measurement.prepare(caches, {}, nobody);
    measurement.find_compulsory(std::vector<std::uint32_t>{128});
    std::vector<double> traffic;
    for (const reorder::ParsedOrdering& parsed : orderings.all) {
        const auto rows = measurement.rows(parsed, measurement.order(*parsed.ordering), caches, nobody);
        traffic.push_back(static_cast<double>(*rows.at(0).traffic_bytes));
        EXPECT_GE(traffic.back(), static_cast<double>(measurement.compulsory_bytes.at(128)));
    }
    EXPECT_LT(traffic[0], 0.5 * traffic[2]);  // of the whole image
    EXPECT_LT(traffic[1], 0.8 * traffic[2]);  // of tiles
    EXPECT_LT(traffic[2], 0.9 * traffic[3]);
    for (std::size_t i = 0; i < specs.size(); ++i)
        RecordProperty(specs[i].substr(0, 7) + std::to_string(i), std::to_string(traffic[i]));
}

}  // namespace
}  // namespace regather::experiment
