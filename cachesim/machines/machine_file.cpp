// The JSON of a machine, read strictly: each refusal is one line "FILE: line L, FIELD: found X, expected Y".
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "cachesim/machines/machine.h"
#include "trace/error.h"
#include "trace/field.h"
#include "trace/text.h"

namespace regather::cachesim {

namespace {

using trace::DataError, trace::Field, trace::Key, trace::Kind;

constexpr bool required = true, optional = false;
constexpr std::string_view bytes = "a whole number of bytes", picojoules = "a whole number of picojoules";
constexpr std::string_view name_of_64 = "a name of 1 to 64 letters, digits, '_', '-' or '.'";
constexpr std::string_view some_ways = "a whole number of ways from 1 up, or \"full\"";

const Kind machine_kind{"machine",
                        {{"name", required, name_of_64},
                         {"summary", optional, "a text"},
                         {"levels", required, "a list of 1 to 4 levels, nearest first"},
                         {"dram", optional, "an object"}}};
const Kind level_kind{"level",
                      {{"name", required, name_of_64},
                       {"size_bytes", required, bytes},
                       {"line_bytes", required, bytes},
                       {"ways", required, some_ways},
                       {"policy", optional, "the name of a policy"},
                       {"seed", optional, "a whole number"},
                       {"write", optional, "the name of a write policy"},
                       {"write_miss", optional, "what a write that misses does"},
                       {"index", optional, "the name of a set index"},
                       {"inclusion", optional, "the name of an inclusion"},
                       {"sector_bytes", optional, bytes},
                       {"victim_lines", optional, "a whole number of lines"},
                       {"prefetch", optional, "when to prefetch"},
                       {"sources", optional, "an object of texts by key"}}};
const Kind dram_kind{"DRAM",
                     {{"channels", required, "a whole number"},
                      {"ranks", optional, "a whole number"},
                      {"banks", required, "a whole number"},
                      {"row_bytes", required, bytes},
                      {"burst_bytes", required, bytes},
                      {"channel_bytes", optional, bytes},
                      {"bank_hash", optional, "the name of a bank hash"},
                      {"activate_pj", required, picojoules},
                      {"read_pj", required, picojoules},
                      {"write_pj", required, picojoules},
                      {"sources", optional, "an object of texts by key"}}};

/// An object of the file that has been checked, and the table of its keys.
class Object {
public:
    Object(const Field& field, const Kind& kind) : field_(field.check(kind)), kind_(kind) {}

    bool has(std::string_view key) const { return field_.has(key); }
    Field operator[](std::string_view key) const { return field_[key]; }

    template <class Number>
    void read(std::string_view key, Number& into) const {
        constexpr Number most = std::numeric_limits<Number>::max();
        const std::string_view expected = kind_.key(key).expected;
        const std::optional<Field> field = field_.get(key);
        if (!field) return;
        if (field->value().whole() && *field->value().whole() > most)
            field->fail(field->found(), fmt::format("{}, at most {}", expected, most));
        into = field->template whole<Number>(0, most, expected);
    }

    template <class Enum>
    void read_word(std::string_view key, std::span<const std::string_view> words, Enum& into) const {
        if (const std::optional<Field> field = field_.get(key)) into = static_cast<Enum>(field->word(words));
    }

    std::string text(std::string_view key) const {
        const std::optional<Field> field = field_.get(key);
        if (!field) return {};
        const std::string& text = field->text(kind_.key(key).expected);
        const auto control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; };
        if (text.size() > 1000 || std::any_of(text.begin(), text.end(), control))
            field->fail(field->found(), "one line of at most 1000 bytes");
        return text;
    }

    std::string name() const {
        std::string text = this->text("name");
        const bool good =
            !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
                return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || c == '.';
            });
        if (!good) field_["name"].fail(trace::in_quotes(text), name_of_64);
        return text;
    }

    std::vector<Source> sources() const {
        std::vector<Source> sources;
        if (!has("sources")) return sources;
        Kind kind{"table of sources", {}};  // its keys are those of this object
        for (const Key& key : kind_.keys)
            if (key.name != "name" && key.name != "sources")
                kind.keys.push_back({key.name, optional, "a text"});
        const Object object(field_["sources"], kind);
        for (const Key& key : kind.keys)
            if (object.has(key.name)) sources.push_back({std::string(key.name), object.text(key.name)});
        return sources;
    }

private:
    Field field_;
    const Kind& kind_;
};

LevelConfig read_level(const Object& object) {
    LevelConfig level;
    level.name = object.name();
    PolicyConfig& cache = level.cache;
    object.read("size_bytes", cache.geometry.size_bytes);
    object.read("line_bytes", cache.geometry.line_bytes);
    if (const Field ways = object["ways"]; ways.value().text()) {
        if (ways.text() != "full") ways.fail(ways.found(), some_ways);
        cache.geometry.ways = fully_associative;
    } else {
        object.read("ways", cache.geometry.ways);
        if (cache.geometry.ways == 0) ways.fail("0", some_ways);
    }
    object.read_word("policy", std::span(policy_names).first(static_cast<std::size_t>(Policy::opt)),
                     cache.policy);
    object.read("seed", cache.seed);
    object.read_word("write", write_policy_names, cache.write);
    object.read_word("write_miss", write_miss_names, cache.write_miss);
    object.read_word("index", set_index_names, cache.index);
    object.read_word("inclusion", inclusion_names, level.inclusion);
    object.read("sector_bytes", level.sector_bytes);
    if (object.has("sector_bytes") && level.sector_bytes == 0)
        object["sector_bytes"].fail("0", "a power of two, at most the line");
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

}  // namespace

Machine parse_machine(std::string_view text, const std::string& file) {
    const trace::Document document(text, file);
    const Object object(document.root(), machine_kind);
    Machine machine;
    machine.name = object.name();
    machine.summary = object.text("summary");
    const std::string_view expected = machine_kind.key("levels").expected;
    const std::vector<Field> levels = object["levels"].elements(expected);
    if (levels.empty() || levels.size() > max_levels)
        object["levels"].fail(object["levels"].found(), expected);
    for (const Field& entry : levels) {
        const Object level(entry, level_kind);
        machine.levels.push_back(read_level(level));
        machine.sources.push_back(level.sources());
    }
    try {
        check(machine.levels);
    } catch (const trace::UsageError& error) {
        throw DataError(fmt::format("{}: {}", file, error.what()));
    }
    if (object.has("dram")) {
        const Object memory(object["dram"], dram_kind);
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
