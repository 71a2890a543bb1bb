// cli/main.cpp -- the binary `regather`: subcommands, exit codes. 0 done; 1 the run failed; 2 usage; 3 bad data.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "cli/commands.h"
#include "cli/version.h"
#include "trace/error.h"

namespace {

enum Exit { done = 0, run_failed = 1, bad_usage = 2, bad_data = 3 };

int fail(int code, const char* message) {
    fmt::print(stderr, "regather: {}\n", message);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace regather;
    cli::set_command_line(argc, argv);
    CLI::App app("regather: captures what a photon mapper asks of memory, puts the questions into other orders, and "
                 "measures what each order costs and saves.", "regather");
    app.require_subcommand(1);
    app.set_version_flag("--version", cli::version_text());
    cli::add_scenes(app);
    cli::add_capture(app);
    cli::add_walk(app);
    cli::add_replay(app);
    cli::add_cachesim(app);
    cli::add_chart(app);
    cli::add_run(app);
    cli::add_info(app);
    try {
        app.parse(argc, argv);
        return done;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? done : bad_usage;
    } catch (const trace::UsageError& error) {
        return fail(bad_usage, error.what());
    } catch (const trace::DataError& error) {
        return fail(bad_data, error.what());
    } catch (const std::exception& error) {
        return fail(run_failed, error.what());
    }
}
