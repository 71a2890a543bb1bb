#include "cli/capture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <concepts>

#include "trace/error.h"

namespace regather::cli {

namespace {

/// "gather_rays" as an option: "--gather-rays".
std::string option_of(std::string_view key, std::string_view dashes = "--") {
    std::string name = fmt::format("{}{}", dashes, key);
    std::replace(name.begin(), name.end(), '_', '-');
    return name;
}

/// An option of a key, by the type of its value.
struct Adder {
    Command& command;
    const experiment::CaptureKey& key;
    std::string name = option_of(key.name);

    void operator()(bool& to) const { command.flag(option_of(key.name, "--no-"), to, key.help, false); }
    void operator()(double& to) const {
        command.option(name, to, {.least = 0, .infinite = key.infinite}, key.help);
    }
    void operator()(std::string& to) const {
        if (key.words.empty())
            command.option(name, to, key.help);
        else
            command.choice(name, to, {key.words.begin(), key.words.end()}, key.help);
    }
    void operator()(std::vector<std::string>& to) const { command.comma_list(name, to, key.help); }
    template <std::unsigned_integral T>
    void operator()(T& to) const {
        command.option(name, to, {key.least, key.most}, key.help);
    }
};

}  // namespace

void add_capture_options(Command& command, experiment::CaptureOptions& options) {
    for (const experiment::CaptureKey& key : experiment::capture_keys())
        std::visit([&](const auto member) { Adder{command, key}(options.*member); }, key.value);
}

void check_capture_options(const Command& command, const experiment::CaptureOptions& options) {
    for (const experiment::IdleKeys& idle : experiment::idle_keys(options))
        for (const std::string_view key : idle.keys)
            if (command.given(option_of(key)))
                throw trace::UsageError(fmt::format("{}: found beside {} {}, which {}, expected one of them",
                                                    option_of(key), option_of(idle.beside), idle.value,
                                                    idle.reason));
}

}  // namespace regather::cli
