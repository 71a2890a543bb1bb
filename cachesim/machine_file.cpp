// The JSON of a machine, read strictly: each refusal is one line "FILE: FIELD: found X, expected Y".
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "cachesim/machine.h"
#include "trace/error.h"
#include "trace/word.h"

namespace regather::cachesim {

namespace {

using nlohmann::json;
using trace::DataError;

constexpr std::size_t max_depth = 8;  // a machine has 4

struct Key {
    std::string_view name;
    bool required;
    std::string_view expected;
};

constexpr Key machine_keys[] = {{"name", true, "a name of 1 to 64 letters, digits, '_', '-' or '.'"},
                                {"summary", false, "a text"},
                                {"levels", true, "a list of 1 to 4 levels, nearest first"},
                                {"dram", false, "an object"}};
constexpr Key level_keys[] = {{"name", true, "a name of 1 to 64 letters, digits, '_', '-' or '.'"},
                              {"size_bytes", true, "a whole number of bytes"},
                              {"line_bytes", true, "a whole number of bytes"},
                              {"ways", true, "a whole number of ways from 1 up, or \"full\""},
                              {"policy", false, "the name of a policy"},
                              {"seed", false, "a whole number"},
                              {"write", false, "the name of a write policy"},
                              {"write_miss", false, "what a write that misses does"},
                              {"index", false, "the name of a set index"},
                              {"inclusion", false, "the name of an inclusion"},
                              {"sector_bytes", false, "a whole number of bytes"},
                              {"victim_lines", false, "a whole number of lines"},
                              {"prefetch", false, "when to prefetch"},
                              {"sources", false, "an object of texts by key"}};
constexpr Key dram_keys[] = {{"channels", true, "a whole number"},
                             {"ranks", false, "a whole number"},
                             {"banks", true, "a whole number"},
                             {"row_bytes", true, "a whole number of bytes"},
                             {"burst_bytes", true, "a whole number of bytes"},
                             {"channel_bytes", false, "a whole number of bytes"},
                             {"bank_hash", false, "the name of a bank hash"},
                             {"activate_pj", true, "a whole number of picojoules"},
                             {"read_pj", true, "a whole number of picojoules"},
                             {"write_pj", true, "a whole number of picojoules"},
                             {"sources", false, "an object of texts by key"}};

/// Of any text: one line, in quotes, shortened.
std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 60;
    std::string line =
        json(std::string(text.substr(0, most))).dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > most) line.insert(line.size() - 1, "...");
    return line;
}

std::string found(const json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return fmt::format("a list of {}", value.size());
    if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
    return value.dump();
}

/// Builds the document, and refuses on the way a key that comes twice and depth without end.
class Builder {
public:
    explicit Builder(const std::string& file) : file_(file) {}

    bool see(json::parse_event_t event, json& parsed) {
        using Event = json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start) {
            keys_.emplace_back();
            if (keys_.size() > max_depth)
                throw DataError(fmt::format("{}: found objects or lists {} deep, expected at most {}", file_,
                                            keys_.size(), max_depth));
        } else if (event == Event::object_end || event == Event::array_end) {
            keys_.pop_back();
        } else if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second) {
            throw DataError(fmt::format("{}: {}: found the key a second time, expected it once", file_,
                                        in_quotes(parsed.get<std::string>())));
        }
        return true;
    }

private:
    const std::string& file_;
    std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

/// An object of the file, by a table of its keys.
class Object {
public:
    Object(const json& value, std::string path, const std::string& file, std::span<const Key> keys)
        : value_(value), path_(std::move(path)), file_(file), keys_(keys) {
        if (!value_.is_object()) fail("", found(value_), "an object");
        std::vector<std::string_view> names;
        for (const Key& key : keys_) names.push_back(key.name);
        for (const auto& [name, item] : value_.items())
            if (std::find(names.begin(), names.end(), name) == names.end())
                fail("", "unknown key " + in_quotes(name),
                     fmt::format("{} (keys: {})", trace::alternatives(trace::nearest_words(name, names)),
                                 trace::listed(names)));
        for (const Key& key : keys_)
            if (key.required && !value_.contains(key.name)) fail(key.name, "nothing", key.expected);
    }

    [[noreturn]] void fail(std::string_view key, std::string_view what, std::string_view expected) const {
        std::string path = path_;
        if (!key.empty()) path += (path.empty() ? "" : ".") + std::string(key);
        throw DataError(fmt::format("{}: {}found {}, expected {}", file_, path.empty() ? "" : path + ": ",
                                    what, expected));
    }

    const json* get(std::string_view key) const {
        const auto at = value_.find(key);
        return at == value_.end() ? nullptr : &*at;
    }

    template <class Number>
    void read(std::string_view key, Number& into) const {
        const json* const item = get(key);
        if (!item) return;
        // Signed and fractional numbers have types of their own; what 64 bits do not hold was read as a
        // fraction.
        if (!item->is_number_unsigned()) fail(key, found(*item), expected(key));
        const auto number = item->get<std::uint64_t>();
        if (number > std::numeric_limits<Number>::max())
            fail(key, found(*item),
                 fmt::format("{}, at most {}", expected(key), std::numeric_limits<Number>::max()));
        into = static_cast<Number>(number);
    }

    template <class Enum>
    void read_word(std::string_view key, std::span<const std::string_view> words, Enum& into) const {
        const json* const item = get(key);
        if (!item) return;
        const auto word = item->is_string()
                              ? std::find(words.begin(), words.end(), item->get_ref<const std::string&>())
                              : words.end();
        if (word == words.end()) fail(key, found(*item), trace::alternatives(words));
        into = static_cast<Enum>(word - words.begin());
    }

    std::string text(std::string_view key) const {
        const json* const item = get(key);
        if (!item) return {};
        if (!item->is_string()) fail(key, found(*item), expected(key));
        const std::string text = item->get<std::string>();
        const auto control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; };
        if (text.size() > 1000 || std::any_of(text.begin(), text.end(), control))
            fail(key, found(*item), "one line of at most 1000 bytes");
        return text;
    }

    std::string name() const {
        const std::string text = this->text("name");
        const bool good =
            !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
                return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || c == '.';
            });
        if (!good) fail("name", in_quotes(text), expected("name"));
        return text;
    }

    std::vector<Source> sources() const {
        std::vector<Source> sources;
        const json* const item = get("sources");
        if (!item) return sources;
        // Its keys are those of this object.
        std::vector<Key> keys;
        for (const Key& key : keys_)
            if (key.name != "name" && key.name != "sources") keys.push_back({key.name, false, "a text"});
        const Object object(*item, path_.empty() ? "sources" : path_ + ".sources", file_, keys);
        for (const Key& key : keys)
            if (object.get(key.name)) sources.push_back({std::string(key.name), object.text(key.name)});
        return sources;
    }

private:
    std::string_view expected(std::string_view key) const {
        return std::find_if(keys_.begin(), keys_.end(), [&](const Key& k) { return k.name == key; })
            ->expected;
    }

    const json& value_;
    std::string path_;
    const std::string& file_;
    std::span<const Key> keys_;
};

LevelConfig read_level(const Object& object) {
    LevelConfig level;
    level.name = object.name();
    PolicyConfig& cache = level.cache;
    object.read("size_bytes", cache.geometry.size_bytes);
    object.read("line_bytes", cache.geometry.line_bytes);
    if (const json& ways = *object.get("ways"); ways.is_string()) {
        if (ways != "full") object.fail("ways", found(ways), "a whole number of ways from 1 up, or \"full\"");
        cache.geometry.ways = fully_associative;
    } else {
        object.read("ways", cache.geometry.ways);
        if (cache.geometry.ways == 0)
            object.fail("ways", "0", "a whole number of ways from 1 up, or \"full\"");
    }
    object.read_word("policy", std::span(policy_names).first(static_cast<std::size_t>(Policy::opt)),
                     cache.policy);
    object.read("seed", cache.seed);
    object.read_word("write", write_policy_names, cache.write);
    object.read_word("write_miss", write_miss_names, cache.write_miss);
    object.read_word("index", set_index_names, cache.index);
    object.read_word("inclusion", inclusion_names, level.inclusion);
    object.read("sector_bytes", level.sector_bytes);
    if (object.get("sector_bytes") && level.sector_bytes == 0)
        object.fail("sector_bytes", "0", "a power of two, at most the line");
    object.read("victim_lines", level.victim_lines);
    object.read_word("prefetch", prefetch_names, level.prefetch);
    return level;
}

DramConfig read_dram(const Object& object) {
    DramConfig dram;
    object.read("channels", dram.channels);
    object.read("ranks", dram.ranks);
    object.read("banks", dram.banks);
    object.read("row_bytes", dram.row_bytes);
    object.read("burst_bytes", dram.burst_bytes);
    dram.channel_bytes = dram.burst_bytes;
    object.read("channel_bytes", dram.channel_bytes);
    object.read_word("bank_hash", bank_hash_names, dram.bank_hash);
    object.read("activate_pj", dram.activate_pj);
    object.read("read_pj", dram.read_pj);
    object.read("write_pj", dram.write_pj);
    return dram;
}

json parse(std::string_view text, const std::string& file) {
    Builder builder(file);
    try {
        return json::parse(text.begin(), text.end(), [&](int, json::parse_event_t event, json& parsed) {
            return builder.see(event, parsed);
        });
    } catch (const json::parse_error& error) {
        const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
        const auto line = std::count(before.begin(), before.end(), '\n') + 1;
        const std::size_t line_end = before.rfind('\n');
        const std::size_t column =
            before.size() - (line_end == std::string_view::npos ? 0 : line_end + 1) + 1;
        // The library's text opens with its class and its own idea of the place.
        std::string_view reason = error.what();
        if (const std::size_t colon = reason.find(": "); colon != reason.npos)
            reason.remove_prefix(colon + 2);
        throw DataError(fmt::format("{}: line {}, column {}: {}", file, line, column, reason));
    } catch (const json::exception&) {
        throw DataError(fmt::format("{}: found a number that no 64 bits hold, expected JSON", file));
    }
}

}  // namespace

Machine parse_machine(std::string_view text, const std::string& file) {
    const json root = parse(text, file);
    const Object object(root, "", file, machine_keys);
    Machine machine;
    machine.name = object.name();
    machine.summary = object.text("summary");
    const json& levels = *object.get("levels");
    if (!levels.is_array() || levels.empty() || levels.size() > max_levels)
        object.fail("levels", found(levels), "a list of 1 to 4 levels, nearest first");
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Object level(levels[i], fmt::format("levels[{}]", i), file, level_keys);
        machine.levels.push_back(read_level(level));
        machine.sources.push_back(level.sources());
    }
    try {
        check(machine.levels);
    } catch (const trace::UsageError& error) {
        throw DataError(fmt::format("{}: {}", file, error.what()));
    }
    if (const json* const dram = object.get("dram")) {
        const Object memory(*dram, "dram", file, dram_keys);
        machine.dram = read_dram(memory);
        machine.dram_sources = memory.sources();
        try {
            check(*machine.dram);
        } catch (const trace::UsageError& error) {
            throw DataError(fmt::format("{}: dram.{}", file, error.what()));
        }
    }
    return machine;
}

}  // namespace regather::cachesim
