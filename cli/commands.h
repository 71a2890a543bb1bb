// cli/commands.h -- the subcommands of `regather`, in one table; one file each. `add` says what the command
// takes and does; what it does throws trace::UsageError (exit 2), trace::DataError (exit 3) or std::exception
// (exit 1).
#pragma once
#include <span>
#include <string_view>

namespace regather::cli {

class Command;

struct Subcommand {
    std::string_view name;
    std::string_view summary;  ///< One line of `regather --help`.
    void (*add)(Command& command);
};

/// In the order of `regather --help`: the order of the work.
std::span<const Subcommand> subcommands();

void add_scenes(Command& command);
void add_import(Command& command);
void add_capture(Command& command);
void add_reference(Command& command);
void add_walk(Command& command);
void add_replay(Command& command);
void add_frame(Command& command);
void add_detail(Command& command);
void add_heatmap(Command& command);
void add_race(Command& command);
void add_sampling(Command& command);
void add_cachesim(Command& command);
void add_layouts(Command& command);
void add_structures(Command& command);
void add_machines(Command& command);
void add_chart(Command& command);
void add_computation(Command& command);
void add_converge(Command& command);
void add_stability(Command& command);
void add_run(Command& command);
void add_results(Command& command);
void add_info(Command& command);

}  // namespace regather::cli
