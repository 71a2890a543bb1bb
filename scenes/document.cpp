#include "scenes/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "trace/error.h"
#include "trace/word.h"

namespace regather::scenes {

using nlohmann::json;
using trace::DataError;

namespace {

std::string joined(const std::string& path, std::string_view key) {
    const bool plain = !key.empty() && key.size() <= 64 && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    });
    std::string text = path;
    if (!text.empty()) text += '.';
    return text + (plain ? std::string(key) : in_quotes(key));
}

std::vector<std::string_view> names_of(std::span<const Kind> kinds) {
    std::vector<std::string_view> names;
    for (const Kind& kind : kinds) names.push_back(kind.name);
    return names;
}

// The library's exceptions open with their own class and number, which tell users nothing.
std::string_view after(std::string_view text, std::string_view mark) {
    const std::size_t at = text.find(mark);
    return at == std::string_view::npos ? text : text.substr(at + mark.size());
}

// Follows the parser to the object that it is in, to see a key that comes twice.
class DuplicateKeys {
public:
    explicit DuplicateKeys(const std::string& file) : file_(file) {}

    void see(json::parse_event_t event, const json& parsed) {
        switch (event) {
            case json::parse_event_t::object_start:
            case json::parse_event_t::array_start:
                open_.push_back({event == json::parse_event_t::array_start, 0, {}, {}});
                break;
            case json::parse_event_t::object_end:
            case json::parse_event_t::array_end:
                open_.pop_back();
                count_element();
                break;
            case json::parse_event_t::value:
                count_element();
                break;
            case json::parse_event_t::key:
                open_.back().key = parsed.get_ref<const std::string&>();
                if (!open_.back().keys.insert(open_.back().key).second)
                    throw DataError(
                        fmt::format("{}: {}: found the key a second time, expected it once", file_, path()));
                break;
        }
    }

private:
    struct Level {
        bool is_array;
        std::size_t index;
        std::string key;
        std::set<std::string> keys;
    };

    void count_element() {
        if (!open_.empty() && open_.back().is_array) ++open_.back().index;
    }
    std::string path() const {
        std::string text;
        for (const Level& level : open_)
            text = level.is_array ? fmt::format("{}[{}]", text, level.index) : joined(text, level.key);
        return text;
    }

    const std::string& file_;
    std::vector<Level> open_;
};

}  // namespace

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 60;
    std::string line =
        json(std::string(text.substr(0, most))).dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > most) line.insert(line.size() - 1, "...");
    return line;
}

void Node::fail(std::string_view found, std::string_view expected) const {
    throw DataError(fmt::format("{}: {}: found {}, expected {}", *file_, path_.empty() ? "scene" : path_,
                                found, expected));
}

std::string Node::found() const {
    switch (value_->type()) {
        case json::value_t::object:
            return "an object";
        case json::value_t::array:
            return value_->empty() ? "an empty list" : fmt::format("a list of {}", value_->size());
        case json::value_t::string:
            return in_quotes(value_->get_ref<const std::string&>());
        default:
            return value_->dump();
    }
}

void Node::check_object(const Kind& kind, std::string_view noun) const {
    if (!value_->is_object()) fail(found(), "an object");
    std::vector<std::string_view> names;
    for (const Key& key : kind.keys) names.push_back(key.name);
    for (const auto& [name, value] : value_->items()) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        Node(value, joined(path_, name), *file_)
            .fail("unknown key " + in_quotes(name),
                  fmt::format("{} (keys of a {}{}{}: {})",
                              trace::alternatives(trace::nearest_words(name, names)), kind.name,
                              noun.empty() ? "" : " ", noun, trace::listed(names)));
    }
    for (const Key& key : kind.keys)
        if (key.required && !has(key.name))
            Node(*value_, joined(path_, key.name), *file_).fail("nothing", key.expected);
}

const Kind& Node::check_object(std::span<const Kind> kinds, std::string_view discriminator,
                               std::string_view noun, const Kind* otherwise) const {
    if (!value_->is_object()) fail(found(), "an object");
    const std::vector<std::string_view> names = names_of(kinds);
    if (!has(discriminator)) {
        // The discriminator may be there, misspelt: then it is a key of no kind.
        Kind any{noun, {}};
        for (const Kind& kind : kinds)
            for (const Key& key : kind.keys)
                if (std::none_of(any.keys.begin(), any.keys.end(),
                                 [&](const Key& k) { return k.name == key.name; }))
                    any.keys.push_back({key.name, false, key.expected});
        check_object(any);
        if (otherwise != nullptr) {
            check_object(*otherwise, noun);
            return *otherwise;
        }
        Node(*value_, joined(path_, discriminator), *file_).fail("nothing", trace::alternatives(names));
    }
    const Node type = (*this)[discriminator];
    const std::string& name = type.text(trace::alternatives(names));
    for (const Kind& kind : kinds)
        if (kind.name == name) {
            check_object(kind, noun);
            return kind;
        }
    type.fail(in_quotes(name),
              fmt::format("{} ({}s: {})", trace::alternatives(trace::nearest_words(name, names)), noun,
                          trace::listed(names)));
}

bool Node::has(std::string_view key) const {
    return value_->contains(std::string(key));
}

Node Node::operator[](std::string_view key) const {
    return {value_->at(std::string(key)), joined(path_, key), *file_};
}

Node Node::element(std::size_t i) const {
    return {(*value_)[i], fmt::format("{}[{}]", path_, i), *file_};
}

std::vector<Node> Node::elements(std::string_view expected) const {
    if (!value_->is_array()) fail(found(), expected);
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < value_->size(); ++i) nodes.push_back(element(i));
    return nodes;
}

std::vector<std::pair<std::string, Node>> Node::members(std::string_view expected) const {
    if (!value_->is_object()) fail(found(), expected);
    std::vector<std::pair<std::string, Node>> nodes;
    for (const auto& [name, value] : value_->items())
        nodes.emplace_back(name, Node(value, joined(path_, name), *file_));
    return nodes;
}

const std::string& Node::text(std::string_view expected) const {
    if (!value_->is_string()) fail(found(), expected);
    return value_->get_ref<const std::string&>();
}

double Node::number(double low, double high, std::string_view expected, Ends ends) const {
    if (!value_->is_number()) fail(found(), expected);
    const double x = value_->get<double>();
    const bool inside = std::isfinite(x) && (ends == Ends::closed ? x >= low : x > low) &&
                        (ends == Ends::open ? x < high : x <= high);
    if (!inside) fail(found(), expected);
    return x;
}

std::uint32_t Node::whole(std::uint32_t low, std::uint32_t high, std::string_view expected) const {
    const double x = number(low, high, expected);
    if (x != std::floor(x)) fail(found(), expected);
    return static_cast<std::uint32_t>(x);
}

bool Node::truth(std::string_view expected) const {
    if (!value_->is_boolean()) fail(found(), expected);
    return value_->get<bool>();
}

std::array<double, 3> Node::numbers(double low, double high, std::string_view expected) const {
    const std::vector<Node> three = elements(expected);
    if (three.size() != 3) fail(found(), expected);
    return {three[0].number(low, high, expected), three[1].number(low, high, expected),
            three[2].number(low, high, expected)};
}

trace::Vec3 Node::triple(double low, double high, std::string_view expected) const {
    const auto [x, y, z] = numbers(low, high, expected);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

Document::Document(std::string_view text, std::string file) : file_(std::move(file)) {
    DuplicateKeys duplicates(file_);
    try {
        root_ = std::make_unique<json>(
            json::parse(text.begin(), text.end(), [&](int, json::parse_event_t event, const json& parsed) {
                duplicates.see(event, parsed);
                return true;
            }));
    } catch (const json::parse_error& error) {
        // The library's own column is 0 behind a line end; its byte is right.
        const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
        const auto line = std::count(before.begin(), before.end(), '\n') + 1;
        const std::size_t line_end = before.rfind('\n');
        const std::size_t column =
            before.size() - (line_end == std::string_view::npos ? 0 : line_end + 1) + 1;
        throw DataError(
            fmt::format("{}: line {}, column {}: {}", file_, line, column, after(error.what(), ": ")));
    } catch (const json::exception& error) {
        throw DataError(fmt::format("{}: {}", file_, after(error.what(), "] ")));
    }
}

Document::~Document() = default;

Node Document::root() const {
    return {*root_, "", file_};
}

}  // namespace regather::scenes
