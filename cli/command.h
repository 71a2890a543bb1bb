// cli/command.h -- what one subcommand takes: arguments, options and flags with their ranges and conflicts,
// and what is done with them. All that is wrong with a word is said here, in one line: option, what was
// found, what was expected. Words that are empty are refused whatever the option.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/console.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace regather::cli {

/// Whole numbers that an option takes.
struct Whole {
    std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
};

/// Numbers that an option takes; written as 0.5, 2e-3, and, where it is allowed, inf.
struct Real {
    double least = -std::numeric_limits<double>::max();
    bool infinite = false, above = false;  ///< `above`: more than `least`, not as much.
};

/// Each variable that is bound holds its default, which --help shows, and outlives the parse.
class Command {
public:
    /// `title` for --help: "regather capture".
    Command(std::string_view title, std::string_view summary);
    ~Command();
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    class Option {
    public:
        explicit Option(CLI::Option* option) : option_(option) {}
        const Option& required() const;

    private:
        CLI::Option* option_;
    };

    /// Words without a name before them, in the order of these calls.
    Option argument(std::string_view name, std::string& to, std::string_view help);
    Option argument(std::string_view name, std::filesystem::path& to, std::string_view help);
    Option arguments(std::string_view name, std::vector<std::string>& to, std::string_view help);
    Option arguments(std::string_view name, std::vector<std::filesystem::path>& to, std::string_view help);

    /// `names`: "--radius" or "-o,--output".
    Option option(std::string_view names, std::string& to, std::string_view help);
    Option option(std::string_view names, std::filesystem::path& to, std::string_view help);
    Option option(std::string_view names, std::uint32_t& to, Whole range, std::string_view help);
    Option option(std::string_view names, std::uint64_t& to, Whole range, std::string_view help);
    Option option(std::string_view names, std::optional<std::uint32_t>& to, Whole range,
                  std::string_view help);
    Option option(std::string_view names, double& to, Real range, std::string_view help);
    Option option(std::string_view names, std::optional<double>& to, Real range, std::string_view help);
    /// One of `words`.
    Option choice(std::string_view names, std::string& to, std::vector<std::string_view> words,
                  std::string_view help);
    /// Every word up to the next option.
    Option list(std::string_view names, std::vector<std::string>& to, std::string_view help);
    /// Likewise, one word for each of several things: the same may be there again.
    Option sequence(std::string_view names, std::vector<std::string>& to, std::string_view help);
    /// As list(); commas separate, too.
    Option comma_list(std::string_view names, std::vector<std::string>& to, std::string_view help);
    Option comma_list(std::string_view names, std::vector<std::uint32_t>& to, Whole range,
                      std::string_view help);
    void flag(std::string_view names, bool& to, std::string_view help, bool value = true);

    /// Both at once are refused. Names as in --help, with their dashes.
    void conflict(std::string_view one, std::initializer_list<std::string_view> others);
    /// One without any of the others is refused.
    void needs(std::string_view one, std::initializer_list<std::string_view> others);
    bool given(std::string_view name) const;

    void footer(std::string_view text);
    /// What the command does. `state` is kept: it holds the bound variables.
    template <class State, class Work>
    void action(std::shared_ptr<State> state, Work work) {
        action_ = [state = std::move(state), work = std::move(work)](const Console& console) {
            work(*state, console);
        };
    }

    /// Binds the words. False when they ask for help, which then is printed. Throws trace::UsageError.
    bool parse(std::span<const std::string> words, const Console& console);
    void run(const Console& console) const { action_(console); }
    std::string help() const;
    /// Names of the options that take a word, with their dashes.
    std::vector<std::string> options() const;

private:
    struct Pair {
        std::string one;
        std::vector<std::string> others;
        bool exclusive;
    };
    void check_pairs() const;

    std::unique_ptr<CLI::App> app_;
    std::vector<Pair> pairs_;
    std::function<void(const Console&)> action_;
};

}  // namespace regather::cli
