// regather cachesim -- a user's address trace through LRU caches: every size x line x ways in one pass over
// the file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/address_trace.h"
#include "cachesim/sweep.h"
#include "cli/commands.h"
#include "cli/size.h"
#include "trace/error.h"
#include "trace/file.h"

namespace regather::cli {

namespace {

struct Options {
    cachesim::AddressFiles files;
    std::string sizes, lines, ways;
    std::filesystem::path csv;
    bool force = false;
};

std::vector<std::string_view> split(std::string_view list) {
    std::vector<std::string_view> parts;
    for (std::size_t comma; (comma = list.find(',')) != list.npos; list.remove_prefix(comma + 1))
        parts.push_back(list.substr(0, comma));
    parts.push_back(list);
    return parts;
}

std::uint32_t parse_line(std::string_view text) {
    const std::uint64_t bytes = parse_size(text);
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        throw trace::UsageError(fmt::format("--line: found {}, expected less than 4G", text));
    return static_cast<std::uint32_t>(bytes);
}

std::uint32_t parse_ways(std::string_view text) {
    if (text == "full") return cachesim::fully_associative;
    std::uint32_t ways = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, ways);
    if (error != std::errc{} || end != last || ways == 0)
        throw trace::UsageError(
            fmt::format("--ways: found '{}', expected a number from 1 up, or full", text));
    return ways;
}

std::vector<cachesim::CacheConfig> combinations(const Options& options) {
    std::vector<cachesim::CacheConfig> configs;
    for (const std::string_view size : split(options.sizes))
        for (const std::string_view line : split(options.lines))
            for (const std::string_view ways : split(options.ways)) {
                configs.push_back({parse_size(size), parse_line(line), parse_ways(ways)});
                try {
                    check(configs.back());
                } catch (const trace::UsageError& error) {
                    throw trace::UsageError(
                        fmt::format("--size {} --line {} --ways {}: {}", size, line, ways, error.what()));
                }
            }
    return configs;
}

std::string table(std::span<const cachesim::LruCache> caches) {
    std::string rows = "policy,size_bytes,line_bytes,ways,accesses,misses,traffic_bytes\n";
    for (const cachesim::LruCache& cache : caches) {
        const cachesim::CacheConfig& config = cache.config();
        const cachesim::CacheStats stats = cache.total();
        const std::string ways =
            config.ways == cachesim::fully_associative ? "full" : fmt::format("{}", config.ways);
        rows += fmt::format("lru,{},{},{},{},{},{}\n", config.size_bytes, config.line_bytes, ways,
                            stats.accesses, stats.misses, cache.traffic_bytes());
    }
    return rows;
}

void write_all(std::FILE* file, std::string_view text, const std::string& name) {
    if (std::fwrite(text.data(), 1, text.size(), file) != text.size() || std::fflush(file) != 0)
        throw std::runtime_error(fmt::format("{}: cannot write: {}", name, std::strerror(errno)));
}

void run(const Options& options) {
    const std::vector<cachesim::CacheConfig> configs = combinations(options);
    if (!options.csv.empty() && !options.force && std::filesystem::exists(options.csv))
        throw trace::UsageError(fmt::format("--csv {}: found a file, expected none (--force overwrites it)",
                                            options.csv.string()));

    cachesim::AddressTrace trace(options.files);
    cachesim::Sweep sweep(configs);
    for (auto records = trace.next(); !records.empty(); records = trace.next()) sweep.access(records);
    sweep.flush();

    const std::string rows = table(sweep.caches());
    if (options.csv.empty())
        write_all(stdout, rows, "stdout");
    else
        trace::write_file(options.csv, rows);
}

}  // namespace

void add_cachesim(CLI::App& app) {
    CLI::App* command = app.add_subcommand("cachesim", "Simulate LRU caches on an address trace of your own");
    auto options = std::make_shared<Options>();
    command
        ->add_option(
            "ADDRESSES", options->files.addresses,
            "A .npy of uint64 byte addresses, or Dinero din text (label and hexadecimal address a line)")
        ->required();
    command->add_option("--size", options->sizes, "Cache sizes in bytes: 4096, 16K, 1M")->required();
    command->add_option("--line", options->lines, "Line sizes in bytes, powers of two")->required();
    command->add_option("--ways", options->ways, "Ways: 1 is direct mapped, full is fully associative")
        ->required();
    command->add_option("--csv", options->csv, "Write the table here; without it, to stdout");
    command->add_option("--sizes", options->files.sizes,
                        "Bytes of each access: .npy of uint8, uint32 or uint64 (default: 1 each)");
    command->add_option("--writes", options->files.writes,
                        "What each access is: .npy of uint8 or bool, 0 read, 1 write (default: all read)");
    command->add_flag("--force", options->force, "Overwrite the CSV file");
    command->footer(
        "Lists are separated by commas; every combination is a row, all from one pass over the trace.\n"
        "Lines still dirty at the end count as written back.\n"
        "Examples:\n"
        "  regather cachesim addresses.npy --size 16K,128K --line 64,128 --ways 1,8,full --csv misses.csv\n"
        "  regather cachesim program.din --size 32K --line 64 --ways 8");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
