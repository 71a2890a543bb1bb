#include "cli/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <string_view>

#include "cli/command.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/version.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::cli {
namespace {

using WordSpan = std::span<const std::string>;

std::string help() {
    std::size_t widest = 0;
    for (const Subcommand& command : subcommands()) widest = std::max(widest, command.name.size());
    std::string text =
        "regather: captures what a photon mapper asks of memory, puts the questions into other orders, and\n"
        "measures what each order costs and saves.\n"
        "Usage: regather SUBCOMMAND [OPTIONS]\n\n"
        "Options:\n  -h,--help   print this and stop\n  --version   print the version and "
        "stop\n\nSubcommands:\n";
    for (const Subcommand& command : subcommands())
        text += fmt::format("  {:<{}}  {}\n", command.name, widest, command.summary);
    return text +
           "\nregather SUBCOMMAND --help shows its options and examples.\n"
           "Exit codes: 0 done; 1 the run failed; 2 wrong usage; 3 bad data; 130 and 143 ended by SIGINT and "
           "SIGTERM.\n";
}

std::vector<std::string_view> names() {
    std::vector<std::string_view> all;
    for (const Subcommand& command : subcommands()) all.push_back(command.name);
    return all;
}

/// Words that begin with no subcommand's name.
void run_without_subcommand(WordSpan words, const Console& console) {
    if (words.empty())
        throw trace::UsageError(
            fmt::format("SUBCOMMAND: found nothing, expected one of {}", trace::listed(names())));
    const std::string& word = words.front();
    if (word == "--help" || word == "-h") return console.print("{}", help());
    if (word == "--version") return console.print("{}\n", version_text());
    if (word.starts_with('-')) {
        static constexpr std::string_view options[] = {"--help", "--version"};
        throw trace::UsageError(fmt::format("found the unknown option '{}', expected {}", trace::shown(word),
                                            trace::alternatives(trace::nearest_words(word, options))));
    }
    throw trace::UsageError(
        fmt::format("found the unknown subcommand '{}', expected {} (known: {})", trace::shown(word),
                    trace::alternatives(trace::nearest_words(word, names())), trace::listed(names())));
}

void run_words(WordSpan words, const Console& console) {
    const auto known = subcommands();
    const auto entry = std::find_if(known.begin(), known.end(), [&](const Subcommand& one) {
        return !words.empty() && one.name == words.front();
    });
    const std::string title = entry == known.end() ? "regather" : fmt::format("regather {}", entry->name);
    Command command(title, entry == known.end() ? "" : entry->summary);
    try {
        if (entry == known.end()) return run_without_subcommand(words, console);
        entry->add(command);
        if (!command.parse(words.subspan(1), console)) return;
    } catch (const trace::UsageError& error) {
        throw trace::UsageError(fmt::format("{} (see {} --help)", error.what(), title));
    }
    command.run(console);
}

int fail(const Console& console, int code, std::string_view message) {
    constexpr std::size_t most = 4000;  // lists of what is known are some hundred bytes
    fmt::print(console.err, "regather: {}\n", trace::shown(message, most));
    std::fflush(console.err);
    return code;
}

}  // namespace

int run(const Console& console) {
    try {
        run_words(
            WordSpan(console.command_line).subspan(std::min<std::size_t>(1, console.command_line.size())),
            console);
        // What was printed has reached its file, or the run has failed.
        if (std::fflush(console.out) == 0 && std::ferror(console.out) == 0) return done;
        return fail(console, run_failed, fmt::format("stdout: cannot write: {}", std::strerror(errno)));
    } catch (const Interrupted& interrupted) {
        return fail(console, 128 + interrupted.signal, interrupted.what());
    } catch (const trace::UsageError& error) {
        return fail(console, bad_usage, error.what());
    } catch (const trace::DataError& error) {
        return fail(console, bad_data, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        const bool too_long = error.code() == std::errc::filename_too_long;
        return fail(console, too_long ? bad_usage : run_failed,
                    fmt::format("{}: {}", trace::shown(error.path1().string()), error.code().message()));
    } catch (const std::bad_alloc&) {
        return fail(console, run_failed, "found too little memory for this run, expected more");
    } catch (const std::exception& error) {
        return fail(console, run_failed, error.what());
    }
}

}  // namespace regather::cli
