// cli/main.cpp -- the binary `regather`: subcommands, exit codes. 0 done; 1 the run failed; 2 usage; 3 bad
// data.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/version.h"
#include "trace/error.h"
#include "trace/word.h"

using namespace regather;

namespace {

enum Exit { done = 0, run_failed = 1, bad_usage = 2, bad_data = 3 };

int fail(int code, std::string_view message) {
    fmt::print(stderr, "regather: {}\n", message);
    return code;
}

/// A word that nobody expected, with the nearest that somebody would have.
std::string unexpected(const CLI::App& command, bool is_root, const std::string& word) {
    const bool is_option = word.starts_with('-');
    std::vector<std::string> known;
    if (is_option) {
        for (const CLI::Option* option : command.get_options())
            for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    } else if (is_root) {
        for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
            known.push_back(sub->get_name());
    }
    if (known.empty()) return fmt::format("found '{}', expected nothing more", word);
    const std::vector<std::string_view> words(known.begin(), known.end());
    return fmt::format("found the unknown {} '{}', expected {}{}", is_option ? "option" : "subcommand", word,
                       trace::alternatives(trace::nearest_words(word.substr(0, word.find('=')), words)),
                       is_option ? "" : fmt::format(" (known: {})", trace::listed(words)));
}

/// One line: what was wrong with the words of the command line, and where to read on.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    const CLI::App& command = parsed.empty() ? app : *parsed.front();
    const std::vector<std::string> left_over = command.remaining();
    const bool misspelt =
        !left_over.empty() && (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) ||
                               error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError));
    return fmt::format(
        "{} (see regather {}--help)",
        misspelt ? unexpected(command, parsed.empty(), left_over.front()) : std::string(error.what()),
        parsed.empty() ? "" : command.get_name() + " ");
}

/// What was printed has reached its file, or the run has failed.
int finish() {
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return done;
    return fail(run_failed, fmt::format("stdout: cannot write: {}", std::strerror(errno)));
}

}  // namespace

int main(int argc, char** argv) {
    cli::set_command_line(argc, argv);
    CLI::App app(
        "regather: captures what a photon mapper asks of memory, puts the questions into other orders, and "
        "measures what each order costs and saves.",
        "regather");
    app.require_subcommand(1);
    app.set_version_flag("--version", cli::version_text());
    cli::add_scenes(app);
    cli::add_import(app);
    cli::add_capture(app);
    cli::add_reference(app);
    cli::add_walk(app);
    cli::add_replay(app);
    cli::add_detail(app);
    cli::add_heatmap(app);
    cli::add_race(app);
    cli::add_sampling(app);
    cli::add_cachesim(app);
    cli::add_machines(app);
    cli::add_chart(app);
    cli::add_converge(app);
    cli::add_stability(app);
    cli::add_run(app);
    cli::add_info(app);
    try {
        app.parse(argc, argv);
        return finish();
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) return fail(bad_usage, explain(app, error));
        app.exit(error);  // --help and --version
        return finish();
    } catch (const trace::UsageError& error) {
        return fail(bad_usage, error.what());
    } catch (const trace::DataError& error) {
        return fail(bad_data, error.what());
    } catch (const std::exception& error) {
        return fail(run_failed, error.what());
    }
}
