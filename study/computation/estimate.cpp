#include "study/computation/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::study {
namespace {

constexpr double giga = 1e9;  // [FLOP]

/// A line of the table that is a product, below the parameters that it is made of.
struct Product {
    Input behind;  ///< Follows this parameter.
    std::string_view what, printed;
    double (*value)(const Operations&);
    bool in_giga;
    bool always;  ///< Also where all estimates have 0.
};
constexpr Product products[] = {
    {Input::samples, "eye rays", "1572864", [](const Operations& of) { return of.eye_rays; }, false, true},
    {Input::specular_rays, "specular rays", "", [](const Operations& of) { return of.specular_rays; }, false,
     false},
    {Input::shadow_rays, "shadow rays", "25165824", [](const Operations& of) { return of.shadow_rays; },
     false, true},
    {Input::gather_rays, "gather rays", "", [](const Operations& of) { return of.gather_rays; }, false, true},
    {Input::gather_rays, "rays cast", "187170816", [](const Operations& of) { return of.rays(); }, false,
     true},
    {Input::ray_flops, "ray generation [GFLOP]", "3.37", [](const Operations& of) { return of.generation; },
     true, true},
    {Input::node_flops, "ray casting [GFLOP]", "112", [](const Operations& of) { return of.casting; }, true,
     true},
    {Input::distance_flops, "photon gathers [GFLOP]", "321", [](const Operations& of) { return of.gathers; },
     true, true},
    {Input::sample_flops, "importance sampling [GFLOP]", "", [](const Operations& of) { return of.sampling; },
     true, true},
    {Input::record_flops, "irradiance caching [GFLOP]", "", [](const Operations& of) { return of.caching; },
     true, true},
    {Input::record_flops, "total [GFLOP]", "437", [](const Operations& of) { return of.total(); }, true,
     true},
};

/// What Table 2 prints for a parameter.
std::string printed(Input input) {
    const ComputationParameter& parameter = computation_parameters()[static_cast<std::size_t>(input)];
    if (parameter.source != "Table 2") return "";
    return input == Input::pixels ? "1024 x 768" : fmt::format("{:.10g}", parameter.paper);
}

std::string value_text(double value) {
    return std::floor(value) == value && value < 1e15 ? fmt::format("{:.0f}", value)
                                                      : fmt::format("{:.6g}", value);
}

std::string source_of(const ComputationEstimate& estimate, std::size_t i) {
    const std::string& source = estimate.counted.sources[i];
    return source.empty() ? std::string(computation_parameters()[i].source) : source;
}

}  // namespace

std::vector<GivenValue> parse_values(std::span<const std::string> words, std::string_view option) {
    std::vector<std::string_view> names;
    for (const ComputationParameter& parameter : computation_parameters()) names.push_back(parameter.name);
    std::vector<GivenValue> out;
    for (const std::string& word : words) {
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string_view name = std::string_view(word).substr(0, equals);
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw trace::UsageError(fmt::format(
                "{}: unknown parameter {}; nearest: {}; known: {}", option, trace::in_quotes(name),
                trace::nearest_words(name, names).front(), trace::listed(names)));
        const GivenValue given{
            static_cast<Input>(found - names.begin()), [&] {
                const std::string_view text =
                    std::string_view(word).substr(std::min(equals + 1, word.size()));
                double value = 0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
                if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
                    throw trace::UsageError(fmt::format("{}: {} is {}, expected {}=NUMBER", option, name,
                                                        trace::in_quotes(text), name));
                return value;
            }()};
        check_value(given.input, given.value, option);
        if (std::any_of(out.begin(), out.end(),
                        [&](const GivenValue& other) { return other.input == given.input; }))
            throw trace::UsageError(fmt::format("{}: {} is given twice", option, name));
        out.push_back(given);
    }
    return out;
}

std::vector<results::ComputationRow> sensitivity_of(const ComputationEstimate& estimate, double factor) {
    const Operations at = operations(estimate.counted.values);
    std::vector<results::ComputationRow> rows;
    for (std::size_t i = 0; i < input_count; ++i) {
        const auto total_with = [&](double value) {
            Computation changed = estimate.counted.values;
            changed.values[i] = value;
            return operations(changed).total();
        };
        const ComputationParameter& parameter = computation_parameters()[i];
        const double value = estimate.counted.values.values[i];
        results::ComputationRow& row = rows.emplace_back();
        row.scene = estimate.scene;
        row.model = estimate.model;
        row.parameter = parameter.name;
        row.what = parameter.what;
        row.value = value;
        row.source = source_of(estimate, i);
        row.factor = factor;
        row.rays = at.rays();
        row.generation_flop = at.generation;
        row.casting_flop = at.casting;
        row.gather_flop = at.gathers;
        row.sampling_flop = at.sampling;
        row.caching_flop = at.caching;
        row.total_flop = at.total();
        row.divided_total_flop = total_with(value / factor);
        row.times_total_flop = total_with(value * factor);
    }
    return rows;
}

results::Table table_of_estimates(std::span<const ComputationEstimate> estimates) {
    using results::Align;
    std::vector<results::Table::Head> heads{
        {"parameter", Align::left}, {"what", Align::left}, {"as printed"}};
    for (const ComputationEstimate& estimate : estimates) heads.push_back({estimate.model});
    heads.push_back({fmt::format("source of {}", estimates.back().model), Align::left});
    results::Table out(std::move(heads));
    std::vector<Operations> all;
    for (const ComputationEstimate& estimate : estimates) all.push_back(operations(estimate.counted.values));
    for (std::size_t i = 0; i < input_count; ++i) {
        const auto input = static_cast<Input>(i);
        const ComputationParameter& parameter = computation_parameters()[i];
        std::vector<std::string> cells{std::string(parameter.name), std::string(parameter.what),
                                       printed(input)};
        for (const ComputationEstimate& estimate : estimates)
            cells.push_back(value_text(estimate.counted.values[input]));
        cells.push_back(source_of(estimates.back(), i));
        out.add(std::move(cells));
        for (const Product& product : products) {
            if (product.behind != input) continue;
            if (!product.always && std::all_of(all.begin(), all.end(),
                                               [&](const Operations& of) { return product.value(of) == 0; }))
                continue;
            std::vector<std::string> line{"", fmt::format("= {}", product.what),
                                          std::string(product.printed)};
            for (const Operations& of : all)
                line.push_back(product.in_giga ? fmt::format("{:.4g}", product.value(of) / giga)
                                               : value_text(product.value(of)));
            out.add(std::move(line));
        }
    }
    return out;
}

}  // namespace regather::study
