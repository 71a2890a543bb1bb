#include "trace/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "trace/text.h"
#include "trace/word.h"

namespace regather::trace {

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

template <class Named>
std::vector<std::string_view> names_of(std::span<const Named> all) {
    std::vector<std::string_view> names;
    for (const Named& one : all) names.push_back(one.name);
    return names;
}

/// The nearest of `words`, and in brackets all of them.
std::string one_of(std::string_view text, std::span<const std::string_view> words, std::string_view what) {
    return fmt::format("{} ({}: {})", alternatives(nearest_words(text, words)), what, listed(words));
}

}  // namespace

const Key& Kind::key(std::string_view key_name) const {
    for (const Key& key : keys)
        if (key.name == key_name) return key;
    throw std::logic_error(fmt::format("no key {} in the table of {}", key_name, name));
}

void Field::fail(std::string_view found, std::string_view expected) const {
    refuse(fmt::format("found {}, expected {}", found, expected));
}

void Field::refuse(std::string_view message) const {
    const std::string& place = path_.empty() ? source_->root_name : path_;
    throw DataError(fmt::format("{}: line {}{}{}: {}", source_->file, value_->line(),
                                place.empty() ? "" : ", ", place, message));
}

std::string Field::found() const {
    if (value_->is_object()) return "an object";
    if (const Json::List* const list = value_->list())
        return list->empty() ? "an empty list" : fmt::format("a list of {}", list->size());
    if (const std::string* const text = value_->text()) return in_quotes(*text);
    return value_->dump();
}

const Field& Field::check(const Kind& kind, std::string_view noun) const {
    if (!value_->is_object()) fail(found(), "an object");
    const std::vector<std::string_view> names = names_of(std::span<const Key>(kind.keys));
    for (const Json::Member& member : *value_->members())
        if (std::find(names.begin(), names.end(), member.key) == names.end())
            (*this)[member.key].fail("unknown key " + in_quotes(member.key),
                                     one_of(member.key, names,
                                            fmt::format("keys of {} {}{}{}", article(kind.name), kind.name,
                                                        noun.empty() ? "" : " ", noun)));
    for (const Key& key : kind.keys)
        if (key.required && !has(key.name))
            Field(*value_, joined(path_, key.name), *source_).fail("nothing", key.expected);
    return *this;
}

const Kind& Field::check(std::span<const Kind> kinds, std::string_view discriminator, std::string_view noun,
                         const Kind* otherwise) const {
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
        check(any);
        if (otherwise != nullptr) {
            check(*otherwise, noun);
            return *otherwise;
        }
        Field(*value_, joined(path_, discriminator), *source_).fail("nothing", alternatives(names));
    }
    const Field type = (*this)[discriminator];
    const std::string& name = type.text(alternatives(names));
    for (const Kind& kind : kinds)
        if (kind.name == name) {
            check(kind, noun);
            return kind;
        }
    type.fail(in_quotes(name), one_of(name, names, fmt::format("{}s", noun)));
}

Field Field::operator[](std::string_view key) const {
    const Json* const value = value_->find(key);
    if (!value) Field(*value_, joined(path_, key), *source_).fail("nothing", "a value");
    return {*value, joined(path_, key), *source_};
}

std::optional<Field> Field::get(std::string_view key) const {
    const Json* const value = value_->find(key);
    if (!value) return std::nullopt;
    return Field(*value, joined(path_, key), *source_);
}

std::vector<Field> Field::elements(std::string_view expected) const {
    if (!value_->list()) fail(found(), expected);
    std::vector<Field> fields;
    for (const Json& value : *value_->list())
        fields.push_back({value, fmt::format("{}[{}]", path_, fields.size()), *source_});
    return fields;
}

std::vector<std::pair<std::string, Field>> Field::members(std::string_view expected) const {
    if (!value_->is_object()) fail(found(), expected);
    std::vector<std::pair<std::string, Field>> fields;
    for (const Json::Member& member : *value_->members())
        fields.emplace_back(member.key, Field(member.value, joined(path_, member.key), *source_));
    return fields;
}

const std::string& Field::text(std::string_view expected) const {
    if (!value_->text()) fail(found(), expected);
    return *value_->text();
}

std::size_t Field::word(std::span<const std::string_view> words) const {
    const std::string* const text = value_->text();
    const auto at = text ? std::find(words.begin(), words.end(), *text) : words.end();
    if (at == words.end()) fail(found(), alternatives(words));
    return static_cast<std::size_t>(at - words.begin());
}

double Field::number(double low, double high, std::string_view expected, Ends ends) const {
    const double x = value_->number();
    const bool inside = std::isfinite(x) && (ends == Ends::closed ? x >= low : x > low) &&
                        (ends == Ends::open ? x < high : x <= high);
    if (!inside) fail(found(), expected);
    return x;
}

std::uint64_t Field::whole_64(std::uint64_t low, std::uint64_t high, std::string_view expected) const {
    std::optional<std::uint64_t> number;
    constexpr double exact = 9007199254740992;  // 2^53: below it a double that is whole is that whole number
    if (value_->whole()) {
        number = *value_->whole();
    } else if (const double x = value_->number(); x >= 0 && x < exact && x == std::floor(x)) {
        number = static_cast<std::uint64_t>(x);
    }
    if (!number || *number < low || *number > high)
        fail(found(), expected.empty() ? fmt::format("a whole number from {} to {}", low, high) : expected);
    return *number;
}

bool Field::truth(std::string_view expected) const {
    if (!value_->truth()) fail(found(), expected);
    return *value_->truth();
}

std::vector<std::string> Field::texts() const {
    std::vector<std::string> all;
    const auto add = [&](const Field& one) {
        if (one.value_->whole()) {
            all.push_back(one.value_->dump());
        } else {
            all.push_back(one.text("a text or a whole number, or a list of them"));
        }
    };
    if (value_->list()) {
        for (const Field& one : elements()) add(one);
    } else {
        add(*this);
    }
    if (all.empty()) fail("an empty list", "at least one value");
    return all;
}

std::array<double, 3> Field::numbers(double low, double high, std::string_view expected) const {
    const std::vector<Field> three = elements(expected);
    if (three.size() != 3) fail(found(), expected);
    return {three[0].number(low, high, expected), three[1].number(low, high, expected),
            three[2].number(low, high, expected)};
}

Vec3 Field::triple(double low, double high, std::string_view expected) const {
    const auto [x, y, z] = numbers(low, high, expected);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

}  // namespace regather::trace
