// regather machines -- the embedded memory systems, or one with the source of each figure.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "cachesim/cache_list.h"
#include "cachesim/machines/machine.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "results/table.h"
#include "trace/size.h"
#include "trace/text.h"

namespace regather::cli {

namespace {

using cachesim::LevelConfig;
using cachesim::Machine;

std::string ways_in_words(const LevelConfig& level) {
    const std::uint32_t ways = level.cache.geometry.ways;
    return cachesim::ways_text(ways) + (ways == cachesim::fully_associative ? "" : "-way");
}

template <class Enum, std::size_t n>
std::string_view word(const std::array<std::string_view, n>& names, Enum value) {
    return names[static_cast<std::size_t>(value)];
}

void print_all(const Console& console) {
    using results::Align;
    results::Table all({{"name", Align::left}, {"levels", Align::left}, {"what", Align::left}});
    for (const cachesim::EmbeddedMachine& row : cachesim::machine_catalogue()) {
        const Machine machine = cachesim::load_machine(row.name);
        std::string levels;
        for (const LevelConfig& level : machine.levels)
            levels += fmt::format("{}{} {} {}", levels.empty() ? "" : ", ", level.name,
                                  trace::size_text(level.cache.geometry.size_bytes), ways_in_words(level));
        all.add({std::string(row.name), levels, machine.summary});
    }
    console.print("{}", results::text_of(all));
}

void print_line(const Console& console, std::string_view label, std::string_view value,
                const std::vector<cachesim::Source>& sources, std::string_view key) {
    const auto source =
        std::find_if(sources.begin(), sources.end(), [&](const auto& s) { return s.key == key; });
    if (source == sources.end())
        console.print("  {:<15}{}\n", label, trace::shown(value));
    else
        console.print("  {:<15}{:<14}{}\n", label, trace::shown(value), trace::shown(source->text, 300));
}

void print_level(const Console& console, const LevelConfig& level,
                 const std::vector<cachesim::Source>& sources) {
    console.print("\n{}: {} sets of {}\n", trace::shown(level.name), level.cache.sets(), level.cache.ways());
    const auto line = [&](std::string_view key, std::string_view value) {
        print_line(console, key, value, sources, key);
    };
    line("size_bytes", fmt::format("{}", level.cache.geometry.size_bytes));
    line("line_bytes", fmt::format("{}", level.line_bytes()));
    line("sector_bytes", fmt::format("{}", level.sector()));
    line("ways", cachesim::ways_text(level.cache.geometry.ways));
    line("policy", name_of(level.cache.policy));
    line("write", word(cachesim::write_policy_names, level.cache.write));
    line("write_miss", word(cachesim::write_miss_names, level.cache.write_miss));
    line("index", word(cachesim::set_index_names, level.cache.index));
    line("inclusion", word(cachesim::inclusion_names, level.inclusion));
    line("victim_lines", fmt::format("{}", level.victim_lines));
    line("prefetch", word(cachesim::prefetch_names, level.prefetch));
}

void print_dram(const Console& console, const cachesim::DramConfig& dram,
                const std::vector<cachesim::Source>& sources) {
    console.print("\ndram\n");
    const auto line = [&](std::string_view key, std::string_view value) {
        print_line(console, key, value, sources, key);
    };
    line("channels", fmt::format("{}", dram.channels));
    line("ranks", fmt::format("{}", dram.ranks));
    line("banks", fmt::format("{}", dram.banks));
    line("row_bytes", fmt::format("{}", dram.row_bytes));
    line("burst_bytes", fmt::format("{}", dram.burst_bytes));
    line("channel_bytes", fmt::format("{}", dram.channel_bytes));
    line("bank_hash", word(cachesim::bank_hash_names, dram.bank_hash));
    line("activate_pj", fmt::format("{}", dram.activate_pj));
    line("read_pj", fmt::format("{}", dram.read_pj));
    line("write_pj", fmt::format("{}", dram.write_pj));
}

void print_details(const std::string& name_or_path, const Console& console) {
    const Machine machine = cachesim::load_machine(name_or_path);
    console.print("{}\n", trace::shown(machine.name));
    if (!machine.summary.empty()) console.print("{}\n", trace::shown(machine.summary, 300));
    for (std::size_t i = 0; i < machine.levels.size(); ++i)
        print_level(console, machine.levels[i], machine.sources[i]);
    if (machine.dram) print_dram(console, *machine.dram, machine.dram_sources);
}

}  // namespace

void add_machines(Command& command) {
    auto machine = std::make_shared<std::string>();
    command.argument("MACHINE", *machine, "an embedded machine's name, or a JSON file");
    command.footer(
        "Examples:\n"
        "  regather machines                  the embedded machines\n"
        "  regather machines gpu-a100         one of them: every figure and where it is from\n"
        "  regather machines my_machine.json  a machine file (docs/machines.md): checked, then shown");
    command.action(machine, [](const std::string& name, const Console& console) {
        name.empty() ? print_all(console) : print_details(name, console);
    });
}

}  // namespace regather::cli
