// trace/field.h -- a value of a JSON file and its place in it, read strictly: by the table of an object's
// keys, by type and by range. Each refusal is one DataError "FILE: line L, PATH: found X, expected Y".
#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "trace/error.h"
#include "trace/json.h"
#include "trace/vec.h"

namespace regather::trace {

/// A key that an object may have.
struct Key {
    std::string_view name;
    bool required;
    std::string_view expected;  ///< "a positive length [m]": what a message says was expected.
};

/// A kind of object ("scene", "sphere", "level") and the table of its keys.
struct Kind {
    std::string_view name;
    std::vector<Key> keys;
    const Key& key(std::string_view key_name) const;  ///< One that is in the table.
};

/// Valid as long as its Document.
class Field {
public:
    const Json& value() const { return *value_; }
    const std::string& path() const { return path_; }  ///< "shapes[3].radius"; empty for the outermost value.
    const std::string& file() const { return source_->file; }
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;
    /// "FILE: line L, PATH: MESSAGE".
    [[noreturn]] void refuse(std::string_view message) const;
    /// What make() gives; its usage errors are this file's bad data.
    template <class Make>
    auto checked(const Make& make) const {
        try {
            return make();
        } catch (const UsageError& error) {
            refuse(error.what());
        }
    }
    /// What is found here, for fail(): "an object", "a list of 3", "\"text\"", "-1".
    std::string found() const;

    /// Refuses anything but an object that has all required keys of `kind` and none beyond its keys. `noun`
    /// follows the kind's name in messages: "sphere shape".
    const Field& check(const Kind& kind, std::string_view noun = "") const;
    /// Which of `kinds` this object is by its text at `discriminator`; checked. `noun`: "shape". Without the
    /// discriminator it is of kind `otherwise`, if there is one.
    const Kind& check(std::span<const Kind> kinds, std::string_view discriminator, std::string_view noun,
                      const Kind* otherwise = nullptr) const;

    bool has(std::string_view key) const { return value_->find(key) != nullptr; }
    Field operator[](std::string_view key) const;  ///< Refuses when the key is missing.
    std::optional<Field> get(std::string_view key) const;
    std::vector<Field> elements(std::string_view expected = "a list") const;
    std::vector<std::pair<std::string, Field>> members(std::string_view expected = "an object") const;

    const std::string& text(std::string_view expected = "a text") const;
    /// Which of `words` the text is.
    std::size_t word(std::span<const std::string_view> words) const;
    /// Finite and low <= x <= high; `open`: low < x < high.
    enum class Ends { closed, open, open_low };
    double number(double low, double high, std::string_view expected, Ends ends = Ends::closed) const;
    /// low <= x <= high, exact to 64 bits; 4.0 and 4e3 are whole, too.
    template <std::unsigned_integral T = std::uint32_t>
    T whole(std::type_identity_t<T> low, std::type_identity_t<T> high, std::string_view expected = "") const {
        return static_cast<T>(whole_64(low, high, expected));
    }
    bool truth(std::string_view expected = "true or false") const;
    /// Of a text or a whole number, or a list of them that is not empty: the numbers as texts.
    std::vector<std::string> texts() const;
    std::array<double, 3> numbers(double low, double high, std::string_view expected) const;
    Vec3 triple(double low, double high, std::string_view expected) const;  ///< numbers(), rounded to floats.

private:
    friend class Document;
    struct Source {
        std::string file, root_name;
    };
    Field(const Json& value, std::string path, const Source& source)
        : value_(&value), path_(std::move(path)), source_(&source) {}
    std::uint64_t whole_64(std::uint64_t low, std::uint64_t high, std::string_view expected) const;

    const Json* value_;
    std::string path_;
    const Source* source_;
};

/// A JSON file that has been parsed. `root` is what messages call its outermost value; it may be empty.
class Document {
public:
    Document(std::string_view text, std::string file, std::string root_name = {})
        : source_{std::move(file), std::move(root_name)}, root_(parse_json(text, source_.file)) {}
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    Field root() const { return {root_, "", source_}; }

private:
    Field::Source source_;
    Json root_;
};

}  // namespace regather::trace
