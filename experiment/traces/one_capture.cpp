#include "experiment/traces/one_capture.h"

#include <fmt/format.h>

#include "trace/digest.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::experiment {

const std::string* kind_of_rays(const trace::TraceInfo& info) {
    const trace::Json* const kind = info.parameters.find("rays");
    return kind ? kind->text() : nullptr;
}

std::string part_name(const trace::TraceInfo& info) {
    if (const std::string* const kind = kind_of_rays(info))
        return fmt::format("{} rays", trace::shown(*kind));
    return info.map == trace::map_names[0] ? "photons" : fmt::format("{} photons", info.map);
}

const trace::Json& capture_parameters(const trace::TraceInfo& info) {
    const trace::Json* const whole = info.parameters.find("capture");
    return kind_of_rays(info) != nullptr && whole ? *whole : info.parameters;
}

void check_one_capture(const trace::TraceReader& first, const trace::TraceReader& other,
                       std::string_view of) {
    const auto differ = [&](std::string_view field, const auto& a, const auto& b) {
        if (a == b) return;
        throw trace::DataError(fmt::format("{}: {}: found {}, expected {} as in {}: {} are of one capture",
                                           (other.folder() / "trace.json").string(), field, b, a,
                                           first.folder().string(), of));
    };
    const trace::TraceInfo &a = first.info(), &b = other.info();
    differ("scene", trace::shown(a.scene), trace::shown(b.scene));
    differ("frame", a.frame ? fmt::format("{}", *a.frame) : "none",
           b.frame ? fmt::format("{}", *b.frame) : "none");
    differ("image_width", a.image_width, b.image_width);
    differ("image_height", a.image_height, b.image_height);
    differ("seed", a.seed, b.seed);
    if (!(capture_parameters(a) == capture_parameters(b)))
        throw trace::DataError(
            fmt::format("{}: parameters: found those of another capture than {} has, expected one capture",
                        (other.folder() / "trace.json").string(), first.folder().string()));
}

std::string checksum_of(std::span<const trace::TraceReader* const> traces) {
    std::string checksums;
    for (const trace::TraceReader* const trace : traces) checksums += trace->checksum();
    return trace::digest_of(checksums);
}

trace::Json parameters_of(std::span<const trace::TraceReader* const> traces, std::string_view key) {
    trace::Json all = trace::Json::object();
    for (const trace::TraceReader* const trace : traces)
        all[part_name(trace->info())] =
            trace::Json::object({{"checksum", trace->checksum()}, {"parameters", trace->info().parameters}});
    trace::Json out = trace::Json::object();
    out[key] = std::move(all);
    if (const trace::Json* const renderer = traces.front()->info().parameters.find("renderer"))
        out["renderer"] = *renderer;
    return out;
}

}  // namespace regather::experiment
