#include "charts/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trace/size.h"

namespace regather::charts {

double Scale::share(double value) const {
    return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

double Scale::at(double share) const {
    return log ? low * std::pow(high / low, share) : low + share * (high - low);
}

std::vector<double> log_ticks(double low, double high) {
    const int first = static_cast<int>(std::floor(std::log10(low)));
    const int last = static_cast<int>(std::ceil(std::log10(high)));
    std::vector<double> all;
    for (int decade = first; decade <= last; ++decade)
        for (const int digit : {1, 2, 5})
            if (digit == 1 || high / low < 200) all.push_back(digit * std::pow(10.0, decade));
    // From the last one at or below `low` to the first at or above `high`.
    const double slack = 1e-9;
    while (all.size() > 2 && all[1] <= low * (1 + slack)) all.erase(all.begin());
    while (all.size() > 2 && all[all.size() - 2] >= high * (1 - slack)) all.pop_back();
    return all;
}

Scale log_scale(std::span<const double> values, std::string (*label)(double)) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    Scale out{true, *least / 1.35, *most * 1.35, {}};
    for (const double tick : log_ticks(out.low, out.high))
        if (tick >= out.low && tick <= out.high) out.ticks.emplace_back(tick, label(tick));
    while (out.ticks.size() > 8) {  // every second one, keeping the last
        std::vector<std::pair<double, std::string>> fewer;
        for (std::size_t i = (out.ticks.size() - 1) % 2; i < out.ticks.size(); i += 2)
            fewer.push_back(out.ticks[i]);
        out.ticks = fewer;
    }
    return out;
}

Scale linear_scale(double high, std::string (*label)(double)) {
    const double decade = std::pow(10.0, std::floor(std::log10(high)));
    double step = decade;
    for (const double factor : {0.2, 0.5, 1.0, 2.0})
        if (high / (factor * decade) <= 5) {
            step = factor * decade;
            break;
        }
    const double steps = std::ceil(high / step - 1e-9);
    Scale out{false, 0, steps * step, {}};
    for (double i = 0; i <= steps; ++i) out.ticks.emplace_back(i * step, label(i * step));
    return out;
}

Scale percent_scale() {
    Scale out{false, 0, 100, {}};
    for (double tick = 0; tick <= 100; tick += 20) out.ticks.emplace_back(tick, plain_number(tick));
    return out;
}

std::string plain_number(double value) {
    return fmt::format("{:.10g}", value);
}

std::string byte_number(double bytes) {
    const auto [number, steps] = trace::scaled_down(bytes, 1000, 1000 * (1 - 1e-9));
    return fmt::format("{:.4g} {}B", number, trace::decimal_prefixes[steps]);
}

std::string kib_number(double bytes) {
    return plain_number(bytes / 1024);
}

}  // namespace regather::charts
