// regather cachesim -- a user's address trace through caches: every size x line x ways x policy in one pass
// over the file.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/cache_list.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "experiment/address_sweep.h"
#include "results/csv.h"
#include "results/provenance.h"
#include "results/table.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::cli {

namespace {

struct CachesimOptions {
    cachesim::AddressFiles files;
    experiment::CacheLists lists;
    std::string machines;
    bool all_lru = false, no_3c = false;
    std::uint64_t opt_limit = cachesim::PolicySweepOptions{}.opt_limit;
    std::filesystem::path csv;
    bool force = false;
};

std::vector<cachesim::PolicyConfig> combinations(const experiment::CacheLists& lists,
                                                 const Console& console) {
    for (const auto& [name, list] :
         {std::pair{"--size", &lists.sizes}, {"--line", &lists.lines}, {"--ways", &lists.ways}})
        if (list->empty())
            throw trace::UsageError(fmt::format("{}: found none, expected one (or --machine)", name));
    experiment::Combinations all = experiment::combinations(lists);
    for (const std::string& text : all.left_out) fmt::print(console.err, "regather: left out {}\n", text);
    return std::move(all.caches);
}

/// What the values tell: options that the others leave without effect.
void check_effects(const Command& command, const CachesimOptions& options) {
    const auto asks_for = [&](std::string_view policy) {
        const auto all = cachesim::list_parts(options.lists.policies);
        return std::find(all.begin(), all.end(), policy) != all.end();
    };
    for (const auto& [name, policy] : {std::pair{"--seed", "random"}, {"--opt-limit", "opt"}})
        if (command.given(name) && !asks_for(policy))
            throw trace::UsageError(
                fmt::format("{}: found without --policy {}, expected both or none", name, policy));
}

/// Every LRU cache of the line sizes.
std::vector<results::CacheRow> all_lru(const CachesimOptions& options,
                                       const experiment::SweepListeners& listeners) {
    std::vector<std::uint32_t> line_sizes;
    if (options.lists.lines.empty()) throw trace::UsageError("--line: found none, expected one");
    for (const std::string_view text : cachesim::list_parts(options.lists.lines)) {
        const std::uint32_t line = cachesim::parse_line_bytes(text);
        if (std::find(line_sizes.begin(), line_sizes.end(), line) != line_sizes.end())
            throw trace::UsageError(fmt::format("--line {}: found twice, expected each once", line));
        line_sizes.push_back(line);
    }
    std::string_view ways = options.lists.ways.empty() ? "16" : std::string_view(options.lists.ways);
    const std::uint32_t most_ways = cachesim::parse_ways(ways);
    if (most_ways == cachesim::fully_associative || most_ways > 32)
        throw trace::UsageError(fmt::format(
            "--ways: found '{}' beside --all-lru, expected the most ways, 1 to 32", trace::shown(ways)));
    return experiment::sweep_all_lru(options.files, line_sizes, most_ways, !options.no_3c, listeners);
}

/// As CSV on stdout; or into the file, with a table on stdout.
template <class R>
void give(const std::vector<R>& rows, const CachesimOptions& options, const Console& console) {
    if (options.csv.empty()) return console.print("{}", results::to_csv<R>(rows));
    results::write_csv<R>(options.csv, rows);
    results::write_provenance(options.csv, provenance(console, {}));
    console.print("{}rows: {}\n", results::text_of(results::table_of<R>(rows)), options.csv.string());
}

void simulate(const CachesimOptions& options, const Console& console) {
    std::vector<cachesim::Machine> machines;
    std::vector<cachesim::PolicyConfig> configs;
    if (!options.machines.empty())
        machines = experiment::load_machines(options.machines);
    else if (!options.all_lru)
        configs = combinations(options.lists, console);
    if (!options.csv.empty()) results::refuse_to_overwrite(options.csv, options.force);
    std::vector<results::CacheRow> caches;
    std::vector<results::MachineRow> levels;
    {
        Progress progress(console);
        const experiment::SweepListeners listeners{progress.listener(), progress.note_listener()};
        if (!machines.empty())
            levels = experiment::sweep_machines(machines, options.files, listeners);
        else if (options.all_lru)
            caches = all_lru(options, listeners);
        else
            caches = experiment::sweep_policies(options.files, configs, {!options.no_3c, options.opt_limit},
                                                listeners);
    }
    machines.empty() ? give(caches, options, console) : give(levels, options, console);
}

}  // namespace

void add_cachesim(Command& command) {
    auto options = std::make_shared<CachesimOptions>();
    command
        .argument(
            "ADDRESSES", options->files.addresses,
            "a .npy of uint64 byte addresses, or Dinero din text (label and hexadecimal address a line)")
        .required();
    command.option("--size", options->lists.sizes, "cache sizes in bytes: 4096, 16K, 1M");
    command.option("--line", options->lists.lines, "line sizes in bytes, powers of two");
    command.option("--ways", options->lists.ways, "ways: 1 is direct mapped, full is fully associative");
    command.option("--machine", options->machines,
                   "in place of the three: memory systems, by name (see regather machines) or file");
    command.option("--policy", options->lists.policies,
                   "what is replaced: lru, fifo, plru, srrip, random, opt");
    command.option("--write", options->lists.write,
                   "back: dirty lines are written back; through: every write");
    command.option("--write-miss", options->lists.write_miss,
                   "allocate: fetches the line; no-allocate: the write goes past the cache");
    command.option("--index", options->lists.index,
                   "set of a line: modulo, or hashed (all bits of its number, XORed)");
    command.flag(
        "--all-lru", options->all_lru,
        "in place of --size: every LRU cache of the lines, 1 to 65536 sets of 1 to 16 (or --ways, up to 32) "
        "ways, and fully associative ones, all from one pass");
    command.option("--seed", options->lists.seed, {}, "of the policy random");
    command.flag("--no-3c", options->no_3c,
                 "leave compulsory, capacity and conflict empty: lru is several times faster");
    command.option("--opt-limit", options->opt_limit, {},
                   "most line accesses kept in memory for opt, 8 bytes each, for each line size");
    command.option("--csv", options->csv,
                   "write the rows here, and X.json beside X.csv; without it, to stdout");
    command.option("--sizes", options->files.sizes,
                   "bytes of each access: .npy of uint8, uint32 or uint64 (default: 1 each)");
    command.option("--writes", options->files.writes,
                   "what each access is: .npy of uint8 or bool, 0 read, 1 write (default: all read)");
    command.flag("--force", options->force, "overwrite the CSV file");
    command.conflict("--machine", {"--size", "--line", "--ways", "--policy", "--write", "--write-miss",
                                   "--index", "--all-lru", "--seed", "--no-3c", "--opt-limit"});
    command.conflict("--all-lru",
                     {"--size", "--policy", "--write", "--write-miss", "--index", "--seed", "--opt-limit"});
    command.needs("--force", {"--csv"});
    command.footer(
        "Lists (of sizes, lines, ways and policies) are separated by commas; every combination is a row, all "
        "from\n"
        "one pass over the trace.\n"
        "Lines still dirty at the end count as written back.\n"
        "Examples:\n"
        "  regather cachesim addresses.npy --size 16K,128K --line 64,128 --ways 1,8,full --csv misses.csv\n"
        "  regather cachesim program.din --size 32K --line 64 --ways 8 --policy lru,plru,opt --write "
        "through\n"
        "  regather cachesim addresses.npy --machine paper-128k,gpu-a100 --csv levels.csv");
    command.action(options, [&command](const CachesimOptions& asked, const Console& console) {
        check_effects(command, asked);
        simulate(asked, console);
    });
}

}  // namespace regather::cli
