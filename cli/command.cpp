#include "cli/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::cli {
namespace {

using Words = std::vector<std::string>;

[[noreturn]] void refuse(std::string_view name, std::string_view found, std::string_view expected) {
    throw trace::UsageError(fmt::format("{}: found {}, expected {}", name, found, expected));
}

std::string in_quotes(std::string_view word) {
    return fmt::format("'{}'", trace::shown(word));
}

/// "--output" of "-o,--output", "--order" of "--order,--reorderer", "scene" of "scene".
std::string long_name(std::string_view names) {
    const std::size_t start = names.find("--");
    if (start != names.npos) names.remove_prefix(start);
    return std::string(names.substr(0, names.find(',')));
}

template <class Number>
std::optional<Number> number_in(std::string_view word) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

std::string in_words(const Whole& range) {
    if (range.most == std::numeric_limits<std::uint64_t>::max())
        return fmt::format("a whole number from {} up", range.least);
    return fmt::format("a whole number from {} to {}", range.least, range.most);
}

std::string in_words(const Real& range) {
    const std::string inf = range.infinite ? ", or inf" : "";
    if (range.least == -std::numeric_limits<double>::max()) return "a number" + inf;
    return fmt::format("a number {}{}{}", range.above ? "above " : "from ", range.least,
                       (range.above ? "" : " up") + inf);
}

std::uint64_t whole(std::string_view name, std::string_view word, const Whole& range) {
    const auto value = number_in<std::uint64_t>(word);
    if (!value || *value < range.least || *value > range.most) refuse(name, in_quotes(word), in_words(range));
    return *value;
}

double real(std::string_view name, std::string_view word, const Real& range) {
    if (range.infinite && word == "inf") return std::numeric_limits<double>::infinity();
    const auto value = number_in<double>(word);
    if (!value || !std::isfinite(*value) || *value < range.least || (range.above && *value == range.least))
        refuse(name, in_quotes(word), in_words(range));
    return *value;
}

const std::string& not_empty(std::string_view name, const std::string& word) {
    if (word.empty()) refuse(name, "''", "a word that is not empty");
    return word;
}

Words split(const Words& words) {
    Words parts;
    for (std::string_view rest : words) {
        for (std::size_t comma; (comma = rest.find(',')) != rest.npos; rest.remove_prefix(comma + 1))
            parts.emplace_back(rest.substr(0, comma));
        parts.emplace_back(rest);
    }
    return parts;
}

std::string joined(const Words& words, const char* between) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
    return text;
}

void refuse_repeated(const std::string& name, const Words& words) {
    for (auto word = words.begin(); word != words.end(); ++word)
        if (std::find(words.begin(), word, *word) != word)
            refuse(name, fmt::format("{} twice", in_quotes(*word)), "each once");
}

/// What no file system takes is wrong usage, before any work is done for it.
const std::string& path_word(std::string_view name, const std::string& word) {
    constexpr std::size_t most_path = 4095, most_name = 255;  // [bytes] PATH_MAX without its 0, NAME_MAX
    std::size_t longest = 0;
    for (const std::filesystem::path& part : std::filesystem::path(word))
        longest = std::max(longest, part.native().size());
    if (word.size() > most_path || longest > most_name)
        refuse(name, fmt::format("a path of {} bytes, {}", word.size(), in_quotes(word)),
               fmt::format("names of at most {} bytes and {} in all", most_name, most_path));
    return word;
}

/// An option of one word, which `take` is given.
template <class Take>
CLI::Option* add_single(CLI::App& app, std::string_view names, std::string_view help, const char* type,
                        const std::string& fallback, Take take) {
    CLI::Option* option = app.add_option(
        std::string(names),
        [name = long_name(names), take = std::move(take)](const Words& words) {
            take(name, not_empty(name, words.front()));
            return true;
        },
        std::string(help));
    option->type_name(type)->expected(1);
    if (!fallback.empty()) option->default_str(fallback);
    return option;
}

/// An option of one word or more, which `take` is given all at once.
template <class Take>
CLI::Option* add_several(CLI::App& app, std::string_view names, std::string_view help, const char* type,
                         const std::string& fallback, Take take, bool repeats = false) {
    CLI::Option* option = app.add_option(
        std::string(names),
        [name = long_name(names), take = std::move(take), repeats](const Words& words) {
            for (const std::string& word : words) not_empty(name, word);
            if (!repeats) refuse_repeated(name, words);
            take(name, words);
            return true;
        },
        std::string(help));
    option->type_name(type)->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args();
    if (!fallback.empty()) option->default_str(fallback);
    return option;
}

/// A word that nobody expected, with the nearest that somebody would have.
std::string unexpected(const CLI::App& app, const std::string& word) {
    if (!word.starts_with('-') || word == "-")
        return fmt::format("found {}, expected nothing more", in_quotes(word));
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const std::vector<std::string_view> names(known.begin(), known.end());
    return fmt::format("found the unknown option {}, expected {}", in_quotes(word),
                       trace::alternatives(trace::nearest_words(word.substr(0, word.find('=')), names)));
}

/// What is wrong, in our words.
std::string explained(const CLI::App& app, const CLI::ParseError& error) {
    const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (missing || dynamic_cast<const CLI::ExtrasError*>(&error))
        if (const Words left = app.remaining(); !left.empty()) return unexpected(app, left.front());
    if (missing)
        for (const CLI::Option* option : app.get_options())
            if (option->get_required() && option->count() == 0)
                return fmt::format("{}: found nothing, expected it: it is required", option->get_name());
    // Its text begins with the option's name.
    const std::string_view text = error.what();
    const std::string name(text.substr(0, text.find_first_of(": ")));
    const CLI::Option* option = app.get_option_no_throw(name);
    if (!option) option = app.get_option_no_throw("--" + name);
    if (!option) return fmt::format("{}: not understood", name);
    if (option->get_items_expected_max() == 0)
        return fmt::format("{}: found a value, expected none", option->get_name());
    if (option->count() > 1) return fmt::format("{}: found {} times, expected once", name, option->count());
    return fmt::format("{}: found nothing behind it, expected {}", name, option->get_type_name());
}

}  // namespace

const Command::Option& Command::Option::required() const {
    option_->required();
    return *this;
}

Command::Command(std::string_view title, std::string_view summary)
    : app_(std::make_unique<CLI::App>(std::string(summary), std::string(title))) {
    app_->set_help_flag("-h,--help", "print this and stop");
}

Command::~Command() = default;

Command::Option Command::argument(std::string_view name, std::string& to, std::string_view help) {
    return option(name, to, help);
}

Command::Option Command::argument(std::string_view name, std::filesystem::path& to, std::string_view help) {
    return option(name, to, help);
}

Command::Option Command::arguments(std::string_view name, std::vector<std::string>& to,
                                   std::string_view help) {
    return list(name, to, help);
}

Command::Option Command::arguments(std::string_view name, std::vector<std::filesystem::path>& to,
                                   std::string_view help) {
    return Option(
        add_several(*app_, name, help, "", "", [&to](const std::string& argument, const Words& words) {
            for (const std::string& word : words) path_word(argument, word);
            to.assign(words.begin(), words.end());
        }));
}

Command::Option Command::option(std::string_view names, std::string& to, std::string_view help) {
    return Option(add_single(*app_, names, help, names.starts_with('-') ? "TEXT" : "", to,
                             [&to](const std::string&, const std::string& word) { to = word; }));
}

Command::Option Command::option(std::string_view names, std::filesystem::path& to, std::string_view help) {
    return Option(add_single(*app_, names, help, names.starts_with('-') ? "PATH" : "", to.string(),
                             [&to](const std::string& name, const std::string& word) {
                                 to = name.starts_with('-') ? path_word(name, word) : word;
                             }));
}

Command::Option Command::option(std::string_view names, std::uint32_t& to, Whole range,
                                std::string_view help) {
    range.most = std::min<std::uint64_t>(range.most, std::numeric_limits<std::uint32_t>::max());
    return Option(add_single(*app_, names, help, "N", fmt::to_string(to),
                             [&to, range](const std::string& name, const std::string& word) {
                                 to = static_cast<std::uint32_t>(whole(name, word, range));
                             }));
}

Command::Option Command::option(std::string_view names, std::uint64_t& to, Whole range,
                                std::string_view help) {
    return Option(add_single(
        *app_, names, help, "N", fmt::to_string(to),
        [&to, range](const std::string& name, const std::string& word) { to = whole(name, word, range); }));
}

Command::Option Command::option(std::string_view names, std::optional<std::uint32_t>& to, Whole range,
                                std::string_view help) {
    range.most = std::min<std::uint64_t>(range.most, std::numeric_limits<std::uint32_t>::max());
    return Option(add_single(*app_, names, help, "N", to ? fmt::to_string(*to) : "",
                             [&to, range](const std::string& name, const std::string& word) {
                                 to = static_cast<std::uint32_t>(whole(name, word, range));
                             }));
}

Command::Option Command::option(std::string_view names, double& to, Real range, std::string_view help) {
    return Option(add_single(
        *app_, names, help, "X", fmt::to_string(to),
        [&to, range](const std::string& name, const std::string& word) { to = real(name, word, range); }));
}

Command::Option Command::option(std::string_view names, std::optional<double>& to, Real range,
                                std::string_view help) {
    return Option(add_single(
        *app_, names, help, "X", to ? fmt::to_string(*to) : "",
        [&to, range](const std::string& name, const std::string& word) { to = real(name, word, range); }));
}

Command::Option Command::choice(std::string_view names, std::string& to, std::vector<std::string_view> words,
                                std::string_view help) {
    return Option(add_single(
        *app_, names, fmt::format("{}: {}", help, trace::listed(words)), "WORD", to,
        [&to, words](const std::string& name, const std::string& word) {
            if (std::find(words.begin(), words.end(), word) == words.end())
                refuse(name, in_quotes(word),
                       fmt::format("{} (known: {})", trace::alternatives(trace::nearest_words(word, words)),
                                   trace::listed(words)));
            to = word;
        }));
}

Command::Option Command::list(std::string_view names, std::vector<std::string>& to, std::string_view help) {
    return Option(add_several(*app_, names, help, names.starts_with('-') ? "TEXT" : "", joined(to, " "),
                              [&to](const std::string&, const Words& words) { to = words; }));
}

Command::Option Command::sequence(std::string_view names, std::vector<std::string>& to,
                                  std::string_view help) {
    return Option(add_several(
        *app_, names, help, "TEXT", joined(to, " "),
        [&to](const std::string&, const Words& words) { to = words; }, true));
}

Command::Option Command::comma_list(std::string_view names, std::vector<std::string>& to,
                                    std::string_view help) {
    return Option(add_several(*app_, names, help, "TEXT", joined(to, ","),
                              [&to](const std::string& name, const Words& words) {
                                  to = split(words);
                                  for (const std::string& word : to) not_empty(name, word);
                                  refuse_repeated(name, to);
                              }));
}

Command::Option Command::comma_list(std::string_view names, std::vector<std::uint32_t>& to, Whole range,
                                    std::string_view help) {
    range.most = std::min<std::uint64_t>(range.most, std::numeric_limits<std::uint32_t>::max());
    Words fallback;
    for (const std::uint32_t value : to) fallback.push_back(fmt::to_string(value));
    return Option(add_several(*app_, names, help, "N", joined(fallback, ","),
                              [&to, range](const std::string& name, const Words& words) {
                                  to.clear();
                                  refuse_repeated(name, split(words));
                                  for (const std::string& word : split(words))
                                      to.push_back(static_cast<std::uint32_t>(whole(name, word, range)));
                              }));
}

void Command::flag(std::string_view names, bool& to, std::string_view help, bool value) {
    app_->add_flag_callback(
            std::string(names), [&to, value] { to = value; }, std::string(help))
        ->disable_flag_override();
}

void Command::conflict(std::string_view one, std::initializer_list<std::string_view> others) {
    pairs_.push_back({std::string(one), {others.begin(), others.end()}, true});
}

void Command::needs(std::string_view one, std::initializer_list<std::string_view> others) {
    pairs_.push_back({std::string(one), {others.begin(), others.end()}, false});
}

bool Command::given(std::string_view name) const {
    return app_->count(std::string(name)) > 0;
}

void Command::footer(std::string_view text) {
    app_->footer(std::string(text));
}

void Command::check_pairs() const {
    for (const Pair& pair : pairs_) {
        if (!given(pair.one)) continue;
        const auto other = std::find_if(pair.others.begin(), pair.others.end(),
                                        [&](const std::string& name) { return given(name); });
        if (pair.exclusive && other != pair.others.end())
            refuse(pair.one, fmt::format("beside {}", *other), "one of them");
        if (!pair.exclusive && other == pair.others.end())
            refuse(pair.one, fmt::format("without {}", joined(pair.others, " or ")), "both or none");
    }
}

bool Command::parse(std::span<const std::string> words, const Console& console) {
    try {
        app_->parse(Words(words.rbegin(), words.rend()));
    } catch (const CLI::CallForHelp&) {
        console.print("{}", help());
        return false;
    } catch (const CLI::ParseError& error) {
        throw trace::UsageError(explained(*app_, error));
    }
    check_pairs();
    return true;
}

std::string Command::help() const {
    return app_->help();
}

std::vector<std::string> Command::options() const {
    std::vector<std::string> names;
    for (const CLI::Option* option : app_->get_options())
        if (!option->get_lnames().empty() && option->get_items_expected_max() > 0)
            names.push_back("--" + option->get_lnames().front());
    return names;
}

}  // namespace regather::cli
