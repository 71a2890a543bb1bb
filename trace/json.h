// trace/json.h -- a JSON value (RFC 8259), the one parser and the one writer. Objects keep the order of the
// file; whole numbers of 64 bits and doubles are exact; each value knows where it stands in its file. How an
// object is read by the table of its keys: trace/field.h.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ranges>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace regather::trace {

class Json {
public:
    struct Member;
    using List = std::vector<Json>;
    using Object = std::vector<Member>;

    Json();  ///< null
    ~Json();
    Json(const Json&);
    Json(Json&&) noexcept;
    Json& operator=(const Json&);
    Json& operator=(Json&&) noexcept;
    Json(std::nullptr_t);
    Json(std::same_as<bool> auto truth) : Json() { set(truth); }
    Json(std::unsigned_integral auto number) requires(!std::same_as<decltype(number), bool>) : Json() {
        set(std::uint64_t{number});
    }
    Json(std::signed_integral auto number) : Json() {
        if (number < 0) {
            set(std::int64_t{number});
        } else {
            set(static_cast<std::uint64_t>(number));
        }
    }
    Json(std::floating_point auto number) : Json() { set(static_cast<double>(number)); }
    Json(std::string text);
    Json(std::string_view text);
    Json(const char* text);
    Json(List list);
    template <std::ranges::input_range Range>
    requires(!std::convertible_to<const Range&, std::string_view> && !std::same_as<Range, Object>)
        Json(const Range& list)
        : Json(List(std::ranges::begin(list), std::ranges::end(list))) {}
    static Json object(std::initializer_list<Member> members = {});

    bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    bool is_object() const { return std::holds_alternative<Object>(value_); }
    bool is_number() const { return value_.index() >= 2 && value_.index() <= 4; }
    bool is_whole() const { return std::holds_alternative<std::uint64_t>(value_); }  ///< From 0 to 2^64 - 1.

    /// Each is null when the value is of another type.
    const bool* truth() const { return std::get_if<bool>(&value_); }
    const std::uint64_t* whole() const { return std::get_if<std::uint64_t>(&value_); }
    const std::int64_t* negative() const { return std::get_if<std::int64_t>(&value_); }  ///< Whole, below 0.
    const std::string* text() const { return std::get_if<std::string>(&value_); }
    const List* list() const { return std::get_if<List>(&value_); }
    const Object* members() const { return std::get_if<Object>(&value_); }
    double number() const;  ///< The nearest double of any number; NaN when the value is none.

    /// Of an object; null when it has no such key, or the value is no object.
    const Json* find(std::string_view key) const;
    /// Of an object, or of null, which becomes one: the value at `key`, which is added as null when missing.
    Json& operator[](std::string_view key);

    /// Where the value begins in the text that it was parsed from, from 1, columns in bytes; 0: it was not
    /// parsed.
    std::uint32_t line() const { return line_; }
    std::uint32_t column() const { return column_; }

    /// The value as JSON: `indent` blanks a level and a line an element; negative: all on one line. Doubles
    /// by the fewest digits that give them back; one that is not finite becomes null, a byte that is no UTF-8
    /// U+FFFD.
    std::string dump(int indent = -1) const;

    /// Equal whatever the order of keys; numbers by their value, 2 and 2.0 alike. Places do not count.
    friend bool operator==(const Json& a, const Json& b);

private:
    friend class JsonBuilder;
    void set(bool truth);
    void set(std::uint64_t number);
    void set(std::int64_t number);
    void set(double number);
    void write(std::string& out, int indent, int depth) const;

    std::variant<std::monostate, bool, std::uint64_t, std::int64_t, double, std::string, List, Object> value_;
    std::uint32_t line_ = 0, column_ = 0;
};

struct Json::Member {
    std::string key;
    Json value;
    friend bool operator==(const Member& a, const Member& b);
};

// Here the types of the variant are whole.
inline Json::Json() = default;
inline Json::~Json() = default;
inline Json::Json(const Json&) = default;
inline Json::Json(Json&&) noexcept = default;
inline Json& Json::operator=(const Json&) = default;
inline Json& Json::operator=(Json&&) noexcept = default;
inline Json::Json(std::nullptr_t) : Json() {}
inline void Json::set(bool truth) {
    value_ = truth;
}
inline void Json::set(std::uint64_t number) {
    value_ = number;
}
inline void Json::set(std::int64_t number) {
    value_ = number;
}
inline void Json::set(double number) {
    value_ = number;
}
inline Json::Json(std::string text) : value_(std::move(text)) {}
inline Json::Json(std::string_view text) : Json(std::string(text)) {}
inline Json::Json(const char* text) : Json(std::string(text)) {}

inline constexpr std::size_t most_json_depth = 64;
inline constexpr std::size_t most_json_values = 1u << 24;

/// One JSON value and nothing behind it. Throws DataError "FILE: line L, column C: found X, expected Y" for
/// anything else: other syntax (comments, NaN, trailing commas), text that is no UTF-8, a key that stands
/// twice in an object, numbers beyond a double's range, more than most_json_depth objects and lists inside
/// each other, more than most_json_values values. `file` is for messages.
Json parse_json(std::string_view text, const std::string& file);

}  // namespace regather::trace
