// regather cachesim -- a user's address trace through caches: every size x line x ways x policy in one pass
// over the file.
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
#include "cachesim/family_sweep.h"
#include "cachesim/policy_sweep.h"
#include "cli/commands.h"
#include "cli/machine.h"
#include "cli/progress.h"
#include "trace/error.h"
#include "trace/file.h"
#include "trace/size.h"

namespace regather::cli {

namespace {

struct Options {
    cachesim::AddressFiles files;
    std::string sizes, lines, ways, policies = "lru", machines;
    std::string write = "back", write_miss = "allocate", index = "modulo";
    std::uint64_t seed = 0;
    bool all_lru = false, no_3c = false;
    std::uint64_t opt_limit = cachesim::PolicySweepOptions{}.opt_limit;
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
    const std::uint64_t bytes = trace::parse_size(text);
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

std::vector<cachesim::PolicyConfig> combinations(const Options& options) {
    for (const auto& [name, list] :
         {std::pair{"--size", &options.sizes}, {"--line", &options.lines}, {"--ways", &options.ways}})
        if (list->empty())
            throw trace::UsageError(fmt::format("{}: found none, expected one (or --machine)", name));
    std::vector<cachesim::PolicyConfig> configs;
    for (const std::string_view size : split(options.sizes))
        for (const std::string_view line : split(options.lines))
            for (const std::string_view ways : split(options.ways))
                for (const std::string_view policy : split(options.policies)) {
                    configs.push_back({{trace::parse_size(size), parse_line(line), parse_ways(ways)},
                                       cachesim::parse_policy(policy),
                                       cachesim::parse_write_policy(options.write),
                                       cachesim::parse_write_miss(options.write_miss),
                                       cachesim::parse_set_index(options.index),
                                       options.seed});
                    try {
                        check(configs.back());
                    } catch (const trace::UsageError& error) {
                        throw trace::UsageError(fmt::format("--size {} --line {} --ways {} --policy {}: {}",
                                                            size, line, ways, policy, error.what()));
                    }
                }
    return configs;
}

constexpr std::string_view header =
    "policy,size_bytes,line_bytes,ways,accesses,hits,misses,compulsory,capacity,conflict,writebacks,"
    "writes_through,traffic_bytes\n";

std::string table(std::span<const cachesim::PolicyRow> results) {
    std::string rows(header);
    for (const auto& [config, stats, classes] : results) {
        const auto& [size_bytes, line_bytes, ways] = config.geometry;
        rows += fmt::format(
            "{},{},{},{},{},{},{},{},{},{},{}\n", name_of(config.policy), size_bytes, line_bytes,
            ways == cachesim::fully_associative ? "full" : fmt::format("{}", ways), stats.accesses,
            stats.hits(), stats.misses,
            classes ? fmt::format("{},{},{}", classes->compulsory, classes->capacity, classes->conflict)
                    : ",,",
            stats.writebacks, stats.passed_writes, stats.traffic_bytes(line_bytes));
    }
    return rows;
}

/// Every LRU cache of the line sizes. What a trace with writes writes back is not told.
std::string all_lru(const Options& options) {
    std::vector<std::uint32_t> line_sizes;
    if (options.lines.empty()) throw trace::UsageError("--line: found none, expected one");
    for (const std::string_view line : split(options.lines)) line_sizes.push_back(parse_line(line));
    std::string_view ways = options.ways.empty() ? "16" : std::string_view(options.ways);
    const std::uint32_t most_ways = parse_ways(ways);
    if (most_ways == cachesim::fully_associative || most_ways > 32)
        throw trace::UsageError(
            fmt::format("--ways: found '{}' beside --all-lru, expected the most ways, 1 to 32", ways));

    cachesim::AddressTrace trace(options.files);
    cachesim::FamilySweep sweep(line_sizes, most_ways, !options.no_3c);
    bool writes = false;
    {
        Progress progress;
        for (auto records = trace.next(); !records.empty(); records = trace.next()) {
            sweep.access(records);
            for (const cachesim::ByteAccess& access : records)
                writes = writes || access.kind == cachesim::Access::write;
            const auto [done, total, unit] = trace.position();
            if (total != 0) progress.update("cachesim: all lru", unit, done, total);
        }
        for (const std::string& note : trace.notes()) progress.note(note);
    }
    std::string text(header);
    for (const cachesim::FamilyRow& row : sweep.rows()) {
        const auto& [size_bytes, line_bytes, row_ways] = row.config;
        text += fmt::format(
            "lru,{},{},{},{},{},{},{},{}\n", size_bytes, line_bytes,
            row_ways == cachesim::fully_associative ? "full" : fmt::format("{}", row_ways), row.accesses,
            row.accesses - row.misses, row.misses,
            options.no_3c ? ",," : fmt::format("{},{},{}", row.compulsory, row.capacity, row.conflict),
            writes ? ",," : fmt::format("0,0,{}", row.misses * line_bytes));
    }
    return text;
}

std::vector<cachesim::PolicyRow> simulate(const Options& options,
                                          std::span<const cachesim::PolicyConfig> configs) {
    cachesim::AddressTrace trace(options.files);
    cachesim::PolicySweep sweep(configs, {!options.no_3c, options.opt_limit});
    Progress progress;
    for (auto records = trace.next(); !records.empty(); records = trace.next()) {
        sweep.access(records);
        const auto [done, total, unit] = trace.position();
        if (total != 0) progress.update("cachesim", unit, done, total);
    }
    for (const std::string& note : trace.notes()) progress.note(note);
    return sweep.finish([&](std::uint64_t done, std::uint64_t total) {
        progress.update("cachesim: opt", "accesses", done, total);
    });
}

void write_all(std::FILE* file, std::string_view text, const std::string& name) {
    if (std::fwrite(text.data(), 1, text.size(), file) != text.size() || std::fflush(file) != 0)
        throw std::runtime_error(fmt::format("{}: cannot write: {}", name, std::strerror(errno)));
}

void run(const Options& options) {
    std::vector<cachesim::Machine> machines;
    std::vector<cachesim::PolicyConfig> configs;
    if (!options.machines.empty())
        machines = load_machines(options.machines);
    else if (!options.all_lru)
        configs = combinations(options);
    if (!options.csv.empty() && !options.force && std::filesystem::exists(options.csv))
        throw trace::UsageError(fmt::format("--csv {}: found a file, expected none (--force overwrites it)",
                                            options.csv.string()));

    const std::string rows = !machines.empty() ? run_machines(machines, options.files)
                             : options.all_lru ? all_lru(options)
                                               : table(simulate(options, configs));
    if (options.csv.empty())
        write_all(stdout, rows, "stdout");
    else
        trace::write_whole(options.csv, rows);
}

}  // namespace

void add_cachesim(CLI::App& app) {
    CLI::App* command = app.add_subcommand("cachesim", "Simulate caches on an address trace of your own");
    auto options = std::make_shared<Options>();
    command
        ->add_option(
            "ADDRESSES", options->files.addresses,
            "A .npy of uint64 byte addresses, or Dinero din text (label and hexadecimal address a line)")
        ->required();
    CLI::Option* const sizes =
        command->add_option("--size", options->sizes, "Cache sizes in bytes: 4096, 16K, 1M");
    CLI::Option* const lines =
        command->add_option("--line", options->lines, "Line sizes in bytes, powers of two");
    CLI::Option* const ways =
        command->add_option("--ways", options->ways, "Ways: 1 is direct mapped, full is fully associative");
    command
        ->add_option("--machine", options->machines,
                     "In place of the three: memory systems, by name (see regather machines) or file")
        ->excludes(sizes)
        ->excludes(lines)
        ->excludes(ways);
    command
        ->add_option("--policy", options->policies, "What is replaced: lru, fifo, plru, srrip, random, opt")
        ->capture_default_str();
    command->add_option("--write", options->write, "back: dirty lines are written back; through: every write")
        ->capture_default_str();
    command
        ->add_option("--write-miss", options->write_miss,
                     "allocate: fetches the line; no-allocate: the write goes past the cache")
        ->capture_default_str();
    command
        ->add_option("--index", options->index,
                     "Set of a line: modulo, or hashed (all bits of its number, XORed)")
        ->capture_default_str();
    command
        ->add_flag("--all-lru", options->all_lru,
                   "In place of --size: every LRU cache of the lines, 1 to 65536 sets of 1 to 16 (or --ways, "
                   "up to 32) "
                   "ways, and fully associative ones, all from one pass")
        ->excludes(sizes);
    command->add_option("--seed", options->seed, "Of the policy random")->capture_default_str();
    command->add_flag("--no-3c", options->no_3c,
                      "Leave compulsory, capacity and conflict empty: lru is several times faster");
    command
        ->add_option("--opt-limit", options->opt_limit,
                     "Most line accesses kept in memory for opt, 8 bytes each, for each line size")
        ->capture_default_str();
    command->add_option("--csv", options->csv, "Write the table here; without it, to stdout");
    command->add_option("--sizes", options->files.sizes,
                        "Bytes of each access: .npy of uint8, uint32 or uint64 (default: 1 each)");
    command->add_option("--writes", options->files.writes,
                        "What each access is: .npy of uint8 or bool, 0 read, 1 write (default: all read)");
    command->add_flag("--force", options->force, "Overwrite the CSV file");
    command->footer(
        "Lists (of sizes, lines, ways and policies) are separated by commas; every combination is a row, all "
        "from\n"
        "one pass over the trace.\n"
        "Lines still dirty at the end count as written back.\n"
        "Examples:\n"
        "  regather cachesim addresses.npy --size 16K,128K --line 64,128 --ways 1,8,full --csv misses.csv\n"
        "  regather cachesim program.din --size 32K --line 64 --ways 8 --policy lru,plru,opt --write "
        "through\n"
        "  regather cachesim addresses.npy --machine paper-128k,gpu-a100 --csv levels.csv");
    command->callback([options] { run(*options); });
}

}  // namespace regather::cli
