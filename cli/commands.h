// cli/commands.h -- the subcommands of `regather`, one file each. Each function adds its subcommand to `app`;
// the callback does the work and throws trace::UsageError (exit 2), trace::DataError (exit 3) or
// std::exception (exit 1).
#pragma once

namespace CLI {
class App;
}

namespace regather::cli {

void add_scenes(CLI::App& app);
void add_import(CLI::App& app);
void add_capture(CLI::App& app);
void add_reference(CLI::App& app);
void add_walk(CLI::App& app);
void add_replay(CLI::App& app);
void add_detail(CLI::App& app);
void add_heatmap(CLI::App& app);
void add_race(CLI::App& app);
void add_sampling(CLI::App& app);
void add_cachesim(CLI::App& app);
void add_machines(CLI::App& app);
void add_chart(CLI::App& app);
void add_converge(CLI::App& app);
void add_stability(CLI::App& app);
void add_run(CLI::App& app);
void add_info(CLI::App& app);

}  // namespace regather::cli
