// `regather computation`: what a capture counts is what its trace.json says; what its rays visit is what
// their walks say elsewhere.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "results/computation_row.h"
#include "results/csv.h"
#include "results/row.h"
#include "tests/cli/expect.h"
#include "trace/folder.h"

namespace regather::cli {
namespace {

namespace fs = std::filesystem;
using results::ComputationRow;
using testing::HasSubstr, testing::Not;
using Words = std::vector<std::string>;

nlohmann::json trace_json(const fs::path& trace) {
    return nlohmann::json::parse(content(trace / "trace.json"));
}

std::string rays_walked(const Scratch& scratch, const std::string& rays, const std::string& structure) {
    const fs::path to = scratch / fmt::format("{} {}", rays, structure);
    if (!fs::exists(to))
        expect_done({"walk", box_trace(), "--rays", rays, "--structure", structure, "-o", to.string()});
    return to.string();
}

/// Rows of one estimate, by parameter.
std::map<std::string, ComputationRow> computed(const Words& words, const std::string& model) {
    const Scratch scratch;
    const fs::path csv = scratch / "rows.csv";
    expect_done(Words{"computation"} + words + Words{"--csv", csv.string()});
    std::map<std::string, ComputationRow> rows;
    for (const ComputationRow& row : results::read_csv<ComputationRow>(csv))
        if (row.model == model) rows.emplace(row.parameter, row);
    return rows;
}

TEST(ComputationCommand, AloneItIsThePapersTable) {
    const std::string text = expect_done({"computation"}).out;
    EXPECT_THAT(text, HasSubstr("= rays cast"));
    EXPECT_THAT(text, HasSubstr("187170816  184025088  187170816"));
    EXPECT_THAT(text, HasSubstr("they need 102 gathers an eye ray (320.9) where the row has 101 (317.7)"));
    const auto rows = computed({"--set", "gather_rays=102,gathers=102", "--factor", "4"}, "set");
    EXPECT_EQ(rows.at("pixels").total_flop, 436535820288);
    EXPECT_EQ(rows.at("pixels").times_total_flop, 4 * 436535820288);
    EXPECT_EQ(rows.at("gathers").source, "--set");
}

TEST(ComputationCommand, AStrategysOperationsAreItsFlop) {
    const auto rows = computed({"--sampling", "cosine"}, "set");
    EXPECT_EQ(rows.at("table_flops").value, 0);
    EXPECT_EQ(rows.at("sample_flops").value, 29);
    EXPECT_EQ(rows.at("pixels").sampling_flop, 1024.0 * 768 * 2 * 100 * 29);
    EXPECT_THAT(expect_done({"computation", "--sampling", "all"}).out, HasSubstr("footprints"));
    EXPECT_EQ(computed({box_trace()}, "measured").at("table_flops").value, 0) << "by the BRDF";
    expect_refused(bad_usage, {"computation", box_trace(), "--sampling", "all"}, {"--sampling", "without"});
    expect_refused(bad_usage, {"computation", "--sampling", "cosin"}, {"nearest: cosine"});
}

TEST(ComputationCommand, ACapturesCountsAreThoseOfItsTraceJson) {
    const nlohmann::json info = trace_json(captured_box() / "trace"), counts = info.at("counts");
    const double eye = counts.at("eye_rays"), queries = info.at("queries");
    EXPECT_EQ(eye, 16 * 16);
    for (const fs::path& folder : {captured_box(), captured_box() / "trace"}) {
        const auto rows = computed({folder.string()}, "counted");
        EXPECT_EQ(rows.at("pixels").value, 256);
        EXPECT_EQ(rows.at("samples").value, 1);
        EXPECT_EQ(rows.at("shadow_rays").value, counts.at("shadow_rays").get<double>() / eye);
        EXPECT_EQ(rows.at("specular_rays").value, counts.at("specular_rays").get<double>() / eye);
        EXPECT_EQ(rows.at("gather_rays").value, counts.at("gather_rays").get<double>() / eye);
        EXPECT_EQ(rows.at("gathers").value, queries / eye);
        EXPECT_EQ(rows.at("found").value, 100);  // the paper's
        const double rays = counts.at("eye_rays").get<double>() + counts.at("specular_rays").get<double>() +
                            counts.at("shadow_rays").get<double>() + counts.at("gather_rays").get<double>();
        EXPECT_NEAR(*rows.at("pixels").rays, rays, 1e-9 * rays);
        EXPECT_NEAR(*rows.at("pixels").casting_flop, rays * 600, 1e-9 * rays * 600);
        EXPECT_NEAR(*rows.at("pixels").gather_flop, queries * 2000, 1e-9 * queries * 2000);
        EXPECT_EQ(rows.at("pixels").scene, "box");
    }
    const auto measured = computed({box_trace()}, "measured");
    EXPECT_EQ(measured.at("found").value, info.at("found_photons").get<double>() / queries);
    EXPECT_EQ(measured.at("looked_at").value, info.at("visited_nodes").get<double>() / queries);
    EXPECT_EQ(measured.at("intersections").value, 20);
    EXPECT_THAT(expect_done({"computation", box_trace()}).out,
                HasSubstr("triangles and nodes a ray: not counted by a capture, Table 2's stand"));
}

// A replay asks for 128 bytes of each inner node of 4 children and 36 of each triangle of a leaf.
TEST(ComputationCommand, WalksTellWhatRaysVisit) {
    const Scratch scratch;
    const nlohmann::json counts = trace_json(captured_box() / "trace").at("counts");
    double bytes = 0, rays = 0;
    Words traces{captured_box().string()};
    for (const std::string kind : {"eye", "shadow", "gather"}) {
        const std::string trace = rays_walked(scratch, kind, "bvh-4:leaf=3");
        traces.push_back(trace);
        const auto replayed = results::from_csv<results::Row>(
            expect_done({"replay", trace, "--order", "naive", "--layout", "depth-first-36"}).out, "stdout");
        ASSERT_GT(replayed.front().raw_bytes.value_or(0), 0u);
        bytes += static_cast<double>(*replayed.front().raw_bytes);
        rays += counts.at(kind + "_rays").get<double>();
    }
    ASSERT_EQ(counts.at("specular_rays"), 0);
    const auto all = computed(traces, "measured");
    const double triangles = all.at("intersections").value.value(), nodes = all.at("nodes").value.value();
    EXPECT_GT(triangles, 1);
    EXPECT_GT(nodes, 1);
    EXPECT_NEAR(nodes * 128 + triangles * 36, bytes / rays, 1e-9 * bytes / rays);
    EXPECT_EQ(all.at("intersections").source, "walks of eye, shadow, gather rays");
    // Leaves of one triangle: what is visited is inner nodes and triangles. Other kinds count with the
    // paper's 20.
    const std::string shadow = rays_walked(scratch, "shadow", "bvh-2:leaf=1");
    const auto one = computed({shadow, box_trace()}, "measured");
    const double visited = trace_json(shadow).at("visited_nodes"), of_shadow = counts.at("shadow_rays");
    EXPECT_NEAR(*one.at("intersections").value + *one.at("nodes").value,
                (visited + 40 * (rays - of_shadow)) / rays, 1e-9 * visited);
    EXPECT_THAT(one.at("nodes").source, HasSubstr("walks of shadow rays; eye, gather rays with Table 2's"));
    // The same photons in leaves: each search looks at those of the leaves that it visits, k at the least.
    expect_done(
        {"walk", box_trace(), "--structure", "median-kd:leaf=1", "-o", (scratch / "median").string()});
    const auto leaves = computed({(scratch / "median").string()}, "measured");
    EXPECT_GE(leaves.at("looked_at").value, 20);
    EXPECT_LT(leaves.at("looked_at").value, trace_json(scratch / "median").at("visited_nodes").get<double>() /
                                                trace_json(scratch / "median").at("queries").get<double>());
}

TEST(ComputationCommand, CausticGathersAreGathersToo) {
    const Scratch scratch;
    const std::string folder = (scratch / "out").string();
    expect_done({"capture", "caustics", "-o", folder, "--width", "12", "--height", "8", "--gather-rays", "4",
                 "--photons", "2000", "--k", "11", "--caustic-photons", "3000", "--caustic-k", "7"});
    const nlohmann::json global = trace_json(scratch / "out/trace"),
                         caustic = trace_json(scratch / "out/caustic-trace");
    const double eye = global.at("counts").at("eye_rays"), a = global.at("queries"),
                 b = caustic.at("queries");
    ASSERT_GT(b, 0);
    const auto rows = computed({folder}, "measured");
    EXPECT_NEAR(*rows.at("gathers").value, (a + b) / eye, 1e-12 * (a + b));
    EXPECT_EQ(
        rows.at("found").value,
        (global.at("found_photons").get<double>() + caustic.at("found_photons").get<double>()) / (a + b));
    EXPECT_THAT(expect_done({"computation", folder}).out,
                HasSubstr(fmt::format("caustic map: {} queries", b)));
    // Elsewhere it is missed, and told.
    fs::rename(scratch / "out/caustic-trace", scratch / "elsewhere");
    EXPECT_NEAR(*computed({folder}, "measured").at("gathers").value, a / eye, 1e-12 * a);
    EXPECT_THAT(expect_done({"computation", folder}).out, HasSubstr("its trace is not here"));
    EXPECT_EQ(computed({(scratch / "elsewhere").string(), folder}, "measured").at("gathers").value,
              rows.at("gathers").value);
}

TEST(ComputationCommand, WhatIsSetStandsAboveWhatIsCounted) {
    const auto rows = computed({box_trace(), "--set", "found=50", "shadow_rays=0"}, "measured");
    EXPECT_EQ(rows.at("found").value, 50);
    EXPECT_EQ(rows.at("found").source, "--set");
    EXPECT_EQ(rows.at("shadow_rays").value, 0);
}

TEST(ComputationCommand, WhatIsNoCaptureOrAbsurdIsRefused) {
    const Scratch scratch;
    const std::string csv = (scratch / "rows.csv").string();
    expect_refused(bad_usage, {"computation", "--set", "gathes=3", "--csv", csv},
                   {"--set", "\"gathes\"", "nearest: gathers", "known: pixels"});
    expect_refused(bad_usage, {"computation", "--set", "pixels=1e18", "--csv", csv}, {"pixels is 1e+18"});
    expect_refused(bad_usage, {"computation", "--factor", "1", "--csv", csv}, {"--factor"});
    expect_refused(bad_usage, {"computation", "--factor", "1e9", "--csv", csv}, {"--factor", "1000"});
    expect_refused(bad_usage, {"computation", box_trace(), captured_box().string()},
                   {"found photons", "each kind once"});
    expect_refused(bad_data, {"computation", (scratch / "none").string()}, {"none", "no such folder"});
    const std::string eye = rays_walked(scratch, "eye", "bvh-2");
    expect_refused(bad_usage, {"computation", eye}, {"found none", "trace of a capture"});
    const auto damaged = [&](const std::string& name, const auto& damage) {
        const fs::path trace = copied_trace(scratch, name);
        nlohmann::json info = trace_json(trace);
        damage(info);
        write(trace / "trace.json", info.dump());
        return trace.string();
    };
    expect_refused(
        bad_data,
        {"computation", damaged("missing", [](auto& info) { info["counts"].erase("shadow_rays"); })},
        {"trace.json: counts.shadow_rays: found nothing, expected a whole number from 0 up"});
    expect_refused(bad_data,
                   {"computation", damaged("zero", [](auto& info) { info["counts"]["eye_rays"] = 0; })},
                   {"counts.eye_rays: found 0, expected a whole number from 1 up"});
    expect_refused(bad_data,
                   {"computation", damaged("text", [](auto& info) { info["counts"]["eye_rays"] = "x"; })},
                   {"counts.eye_rays: found \"x\""});
    expect_refused(
        bad_data,
        {"computation",
         damaged("absurd", [](auto& info) { info["counts"]["gather_rays"] = 18446744073709551615u; })},
        {"trace.json: counts.gather_rays / counts.eye_rays: gather_rays is", "expected a number from 0 to"});
    expect_refused(
        bad_data,
        {"computation", eye, damaged("other", [](auto& info) { info["parameters"]["max_specular"] = 3; })},
        {"parameters: found those of another capture"});
    expect_refused(
        bad_data,
        {"computation", eye, damaged("fewer", [](auto& info) { info["counts"]["eye_rays"] = 255; })},
        {"queries: found 256, expected 255 as counts.eye_rays"});
    EXPECT_FALSE(fs::exists(csv));
}

TEST(ComputationCommand, FilesAreOverwrittenOnlyByForceAndTellTheirTraces) {
    const Scratch scratch;
    const std::string csv = (scratch / "rows.csv").string();
    write(csv, "precious");
    expect_refused(bad_usage, {"computation", box_trace(), "--csv", csv}, {"rows.csv", "--force"});
    EXPECT_EQ(content(csv), "precious");
    expect_done({"computation", box_trace(), "--csv", csv, "--force"});
    const auto json = nlohmann::json::parse(content(scratch / "rows.json"));
    EXPECT_EQ(json.at("trace_checksum"), trace::TraceReader(captured_box() / "trace").checksum());
    EXPECT_EQ(json.at("trace_parameters").at("renderer"),
              trace_json(captured_box() / "trace").at("parameters").at("renderer"));
    EXPECT_EQ(regather({"results", scratch.path().string()}).exit_code, 0);
}

}  // namespace
}  // namespace regather::cli
