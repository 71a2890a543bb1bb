#include "cachesim/policies/policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::cachesim {

namespace {

template <class Choice>
Choice parse(std::string_view field, std::string_view name, std::span<const std::string_view> names) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        std::string known;
        for (const std::string_view each : names) known.append(known.empty() ? "" : ", ").append(each);
        throw trace::UsageError(
            fmt::format("{}: found '{}', expected one of: {}", field, trace::shown(name), known));
    }
    return static_cast<Choice>(found - names.begin());
}

}  // namespace

Policy parse_policy(std::string_view name) {
    return parse<Policy>("policy", name, policy_names);
}
WritePolicy parse_write_policy(std::string_view name) {
    return parse<WritePolicy>("write", name, write_policy_names);
}
WriteMiss parse_write_miss(std::string_view name) {
    return parse<WriteMiss>("write_miss", name, write_miss_names);
}
SetIndex parse_set_index(std::string_view name) {
    return parse<SetIndex>("index", name, set_index_names);
}

void check(const PolicyConfig& config) {
    const std::uint64_t size = config.geometry.size_bytes, line = config.geometry.line_bytes;
    CacheConfig one_set = config.geometry;
    one_set.ways = fully_associative;
    check(one_set);  // the line, the size, and how many lines
    const std::uint64_t lines = size / line;
    const std::uint64_t ways = config.geometry.ways == fully_associative ? lines : config.geometry.ways;
    if (lines % ways != 0)
        throw trace::UsageError(
            fmt::format("ways: found {} ways of {} lines ({} bytes in lines of {}), which is {} sets, "
                        "expected whole sets",
                        ways, lines, size, line, static_cast<double>(lines) / static_cast<double>(ways)));
    if (config.policy == Policy::plru && !std::has_single_bit(ways))
        throw trace::UsageError(
            fmt::format("ways: found {} ways with policy plru, expected a power of two", ways));
    if (config.index == SetIndex::hashed && !std::has_single_bit(lines / ways))
        throw trace::UsageError(
            fmt::format("index: found hashed with {} sets, expected a power of two", lines / ways));
    if (config.policy == Policy::opt && config.write_miss == WriteMiss::no_allocate)
        throw trace::UsageError("write_miss: found no-allocate with policy opt, expected allocate");
}

SetOfLine::SetOfLine(const PolicyConfig& config)
    : how_(!std::has_single_bit(config.sets())                     ? How::modulo
           : config.index == SetIndex::hashed && config.sets() > 1 ? How::fold
                                                                   : How::mask),
      bits_(static_cast<unsigned>(std::bit_width(config.sets() - 1))),
      sets_(config.sets()) {}

std::uint64_t SetOfLine::operator()(Line line) const {
    std::uint64_t rest = static_cast<std::uint64_t>(line);
    if (how_ == How::mask) return rest & (sets_ - 1);
    if (how_ == How::modulo) return rest % sets_;
    std::uint64_t folded = 0;
    for (; rest != 0; rest >>= bits_) folded ^= rest;
    return folded & (sets_ - 1);
}

PolicyStats& PolicyStats::operator+=(const PolicyStats& other) {
    accesses += other.accesses;
    misses += other.misses;
    fetches += other.fetches;
    writebacks += other.writebacks;
    passed_writes += other.passed_writes;
    passed_bytes += other.passed_bytes;
    return *this;
}

}  // namespace regather::cachesim
