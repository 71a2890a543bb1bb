#include "trace/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <unordered_set>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::trace {

namespace {

/// The text, which tells how far it has been read.
class Cursor {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Cursor(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
    const char& operator*() const { return *at_; }
    Cursor& operator++() {
        *furthest_ = ++at_;
        return *this;
    }
    bool operator==(const Cursor& other) const { return at_ == other.at_; }
    bool operator!=(const Cursor& other) const { return at_ != other.at_; }

private:
    const char* at_;
    const char** furthest_;
};

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_word(char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '+' ||
           c == '-' || c == '.';
}

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

}  // namespace

/// Takes the parser's events, builds the value, and says in our words what is wrong.
class JsonBuilder {
public:
    using number_integer_t = nlohmann::json::number_integer_t;
    using number_unsigned_t = nlohmann::json::number_unsigned_t;
    using number_float_t = nlohmann::json::number_float_t;
    using string_t = nlohmann::json::string_t;
    using binary_t = nlohmann::json::binary_t;

    JsonBuilder(std::string_view text, const std::string& file)
        : text_(text), file_(file), furthest_(text.data()), counted_to_(0) {
        if (text.starts_with(byte_order_mark)) end_ = counted_to_ = byte_order_mark.size();
    }

    Json build() {
        nlohmann::json::sax_parse(Cursor(text_.data(), &furthest_),
                                  Cursor(text_.data() + text_.size(), &furthest_), this);
        return std::move(root_);
    }

    bool null() { return scalar(Json()); }
    bool boolean(bool truth) { return scalar(Json(truth)); }
    bool number_integer(number_integer_t number) { return scalar(Json(number)); }
    bool number_unsigned(number_unsigned_t number) { return scalar(Json(number)); }
    bool number_float(number_float_t number, const string_t&) { return scalar(Json(number)); }
    bool string(string_t& text) { return scalar(Json(std::move(text))); }
    bool binary(binary_t&) { return false; }  // of other formats
    bool start_object(std::size_t) { return start(Json::object()); }
    bool start_array(std::size_t) { return start(Json(Json::List())); }
    bool end_object() { return end(); }
    bool end_array() { return end(); }
    bool key(string_t& key) {
        const std::size_t at = token();
        Open& object = open_.back();
        if (!object.add(key))
            fail(at, fmt::format("the key {} a second time", in_quotes(key)), "each key once in an object");
        object.key = std::move(key);
        state_ = State::after_key;
        return true;
    }
    template <class Error>
    bool parse_error(std::size_t read, const std::string&, const Error&) {
        explain(read);
    }

private:
    enum class State { begin, after_key, in_object, in_list, after_member, after_element, end };

    struct Open {
        Json value;
        std::string key;                       // of the member that is read
        std::unordered_set<std::string> keys;  // of many; few are looked through
        explicit Open(Json container) : value(std::move(container)) {}

        bool add(const std::string& new_key) {
            constexpr std::size_t few = 16;
            const Json::Object& members = *value.members();
            if (members.size() < few) return value.find(new_key) == nullptr;
            if (keys.empty())
                for (const Json::Member& member : members) keys.insert(member.key);
            return keys.insert(new_key).second;
        }
    };

    std::string_view rest(std::size_t at) const { return text_.substr(std::min(at, text_.size())); }
    std::size_t behind_blanks(std::size_t at) const {
        while (at < text_.size() && is_blank(text_[at])) ++at;
        return at;
    }
    bool container_is_object() const { return open_.back().value.is_object(); }

    /// Of the event that the parser has just reported: where its token begins. The next is looked for behind
    /// it.
    std::size_t token() {
        std::size_t at = behind_blanks(end_);
        if (at < text_.size() && (text_[at] == ',' || text_[at] == ':')) at = behind_blanks(at + 1);
        end_ = static_cast<std::size_t>(furthest_ - text_.data());
        // To see a number's end the parser reads one byte too many, unless the text ends. A digit is none of
        // its own behind a leading zero.
        const std::size_t digits = at + (text_[at] == '-' ? 1 : 0);
        if (is_digit(text_[digits]) &&
            (!is_digit(text_[end_ - 1]) || (text_[digits] == '0' && end_ == digits + 2)))
            --end_;
        return at;
    }

    void count_lines(std::size_t to) {
        for (; counted_to_ < to; ++counted_to_)
            if (text_[counted_to_] == '\n') {
                ++line_;
                line_begin_ = counted_to_ + 1;
            }
    }

    [[noreturn]] void fail(std::size_t at, const std::string& found, const std::string& expected) {
        count_lines(std::min(at, text_.size()));
        throw DataError(fmt::format("{}: line {}, column {}: found {}, expected {}", file_, line_,
                                    at - line_begin_ + 1, found, expected));
    }

    void place(Json& value, std::size_t at) {
        if (++values_ > most_json_values)
            fail(at, fmt::format("more than {} values", most_json_values), "at most as many");
        count_lines(at);
        value.line_ = static_cast<std::uint32_t>(line_);
        value.column_ = static_cast<std::uint32_t>(at - line_begin_ + 1);
    }

    bool scalar(Json value) {
        place(value, token());
        attach(std::move(value));
        return true;
    }

    bool start(Json container) {
        const std::size_t at = token();
        if (open_.size() == most_json_depth)
            fail(at, fmt::format("objects or lists {} deep", most_json_depth + 1),
                 fmt::format("at most {}", most_json_depth));
        place(container, at);
        state_ = container.is_object() ? State::in_object : State::in_list;
        open_.emplace_back(std::move(container));
        return true;
    }

    bool end() {
        token();
        Json value = std::move(open_.back().value);
        open_.pop_back();
        attach(std::move(value));
        return true;
    }

    void attach(Json value) {
        if (open_.empty()) {
            root_ = std::move(value);
            state_ = State::end;
        } else if (Open& container = open_.back(); container_is_object()) {
            std::get<Json::Object>(container.value.value_)
                .push_back({std::move(container.key), std::move(value)});
            state_ = State::after_member;
        } else {
            std::get<Json::List>(container.value.value_).push_back(std::move(value));
            state_ = State::after_element;
        }
    }

    /// The parser stopped after `read` bytes, in or behind the first token that JSON does not allow here.
    [[noreturn]] void explain(std::size_t read) {
        std::size_t at = behind_blanks(end_);
        const bool comma = at < text_.size() && text_[at] == ',',
                   colon = at < text_.size() && text_[at] == ':';
        const std::string value = "a value", key = "a key in double quotes";
        std::string expected;
        bool wants_text = true, wants_value = true;
        switch (state_) {
            case State::begin:
                expected = value;
                break;
            case State::after_key:
                expected = colon ? value : "':' after the key";
                wants_text = wants_value = colon;
                if (colon) ++at;
                break;
            case State::in_object:
                expected = key + " or '}'";
                wants_value = false;
                break;
            case State::in_list:
                expected = value + " or ']'";
                break;
            case State::after_member:
                expected = comma ? key : "',' or '}'";
                wants_text = comma;
                wants_value = false;
                if (comma) ++at;
                break;
            case State::after_element:
                expected = comma ? value : "',' or ']'";
                wants_text = wants_value = comma;
                if (comma) ++at;
                break;
            case State::end:
                expected = "the end of the file";
                wants_text = wants_value = false;
                break;
        }
        at = behind_blanks(at);
        if (at >= text_.size()) fail(text_.size(), "the end of the file", expected);
        const char first = text_[at];
        if (first == '"' && wants_text) explain_text(at, read);
        if (!is_word(first)) {
            const std::string_view left = rest(at);
            fail(at,
                 first == '"'
                     ? "another text"
                     : "'" + shown(left.substr(0, std::max<std::size_t>(utf8_length(left), 1))) + "'",
                 expected);
        }
        std::size_t word_end = at;
        while (word_end < text_.size() && is_word(text_[word_end])) ++word_end;
        const std::string_view word = text_.substr(at, word_end - at);
        if (wants_value && (is_digit(first) || first == '-')) {
            double number = 0;
            const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
            const bool whole = stop == word.data() + word.size();
            fail(at, shown(word),
                 whole && error == std::errc::result_out_of_range
                     ? fmt::format("a number from {} to {}", std::numeric_limits<double>::lowest(),
                                   std::numeric_limits<double>::max())
                     : std::string("a number as JSON writes them, such as 1, -0.5 or 2e-7"));
        }
        fail(at, shown(word), expected);
    }

    /// A text begins at `at`, and is damaged at the last of the bytes that were read.
    [[noreturn]] void explain_text(std::size_t at, std::size_t read) {
        for (std::size_t i = at; i < std::min(read, text_.size());) {
            const std::size_t length = utf8_length(rest(i));
            if (length == 0)
                fail(i, fmt::format("the byte 0x{:02x} in a text", static_cast<unsigned char>(text_[i])),
                     "UTF-8");
            i += length;
        }
        if (read > text_.size()) fail(text_.size(), "the end of the file in a text", "'\"'");
        const std::size_t bad = read - 1;
        if (const auto byte = static_cast<unsigned char>(text_[bad]); byte < ' ')
            fail(bad,
                 byte == '\n' ? "the end of the line in a text"
                              : fmt::format("the control character 0x{:02x} in a text", byte),
                 byte == '\n' ? "'\"', or \\n" : fmt::format("it as \\u{:04x}", byte));
        const std::size_t escape = text_.rfind('\\', bad);
        fail(escape, shown(text_.substr(escape, read - escape)),
             "one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t, or \\u and four hexadecimal digits, surrogates in "
             "pairs");
    }

    std::string_view text_;
    const std::string& file_;
    const char* furthest_;
    std::size_t end_ = 0;  // behind the last event's token
    std::size_t counted_to_, line_ = 1, line_begin_ = 0;
    std::size_t values_ = 0;
    State state_ = State::begin;
    std::vector<Open> open_;
    Json root_;
};

Json parse_json(std::string_view text, const std::string& file) {
    return JsonBuilder(text, file).build();
}

Json::Json(List list) : value_(std::move(list)) {}

Json Json::object(std::initializer_list<Member> members) {
    Json json;
    json.value_ = Object(members);
    return json;
}

double Json::number() const {
    if (const std::uint64_t* const number = whole()) return static_cast<double>(*number);
    if (const std::int64_t* const number = negative()) return static_cast<double>(*number);
    if (const double* const number = std::get_if<double>(&value_)) return *number;
    return std::numeric_limits<double>::quiet_NaN();
}

const Json* Json::find(std::string_view key) const {
    if (const Object* const object = members())
        for (const Member& member : *object)
            if (member.key == key) return &member.value;
    return nullptr;
}

Json& Json::operator[](std::string_view key) {
    if (is_null()) value_ = Object();
    Object& object = std::get<Object>(value_);
    for (Member& member : object)
        if (member.key == key) return member.value;
    return object.emplace_back(Member{std::string(key), {}}).value;
}

bool operator==(const Json& a, const Json& b) {
    if (a.is_number() && b.is_number()) {
        const bool both_real =
            std::holds_alternative<double>(a.value_) && std::holds_alternative<double>(b.value_);
        if (a.value_.index() == b.value_.index() && !both_real) return a.value_ == b.value_;
        return a.number() == b.number();
    }
    if (a.value_.index() != b.value_.index()) return false;
    const Json::Object* const object = a.members();
    if (!object) return a.value_ == b.value_;
    return object->size() == b.members()->size() &&
           std::all_of(object->begin(), object->end(), [&](const Json::Member& member) {
               const Json* const other = b.find(member.key);
               return other && *other == member.value;
           });
}

bool operator==(const Json::Member& a, const Json::Member& b) {
    return a.key == b.key && a.value == b.value;
}

namespace {

void write_text(std::string& out, std::string_view text) {
    out += '"';
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        const auto byte = static_cast<unsigned char>(character[0]);
        text.remove_prefix(character.size());
        if (length == 0) {
            out += "\xef\xbf\xbd";
        } else if (byte == '"' || byte == '\\') {
            out += '\\';
            out += character;
        } else if (byte == '\n' || byte == '\t' || byte == '\r') {
            out += byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : "\\r";
        } else if (byte < ' ' || byte == 127) {
            out += fmt::format("\\u{:04x}", byte);
        } else {
            out += character;
        }
    }
    out += '"';
}

void write_number(std::string& out, double number) {
    if (!std::isfinite(number)) {
        out += "null";
        return;
    }
    char digits[32];
    const char* const end = std::to_chars(std::begin(digits), std::end(digits), number).ptr;
    const std::string_view text(digits, static_cast<std::size_t>(end - digits));
    out += text;
    if (text.find_first_of(".e") == text.npos) out += ".0";  // a double is read as a double
}

}  // namespace

void Json::write(std::string& out, int indent, int depth) const {
    const auto next_line = [&](int level) {
        if (indent < 0) return;
        out += '\n';
        out.append(static_cast<std::size_t>(indent) * static_cast<std::size_t>(level), ' ');
    };
    if (is_null()) {
        out += "null";
    } else if (truth()) {
        out += *truth() ? "true" : "false";
    } else if (whole()) {
        out += fmt::format("{}", *whole());
    } else if (negative()) {
        out += fmt::format("{}", *negative());
    } else if (is_number()) {
        write_number(out, number());
    } else if (text()) {
        write_text(out, *text());
    } else if (const List* const all = list()) {
        out += '[';
        for (const Json& one : *all) {
            if (&one != all->data()) out += ',';
            next_line(depth + 1);
            one.write(out, indent, depth + 1);
        }
        if (!all->empty()) next_line(depth);
        out += ']';
    } else {
        const Object& object = *members();
        out += '{';
        for (const Member& one : object) {
            if (&one != object.data()) out += ',';
            next_line(depth + 1);
            write_text(out, one.key);
            out += indent < 0 ? ":" : ": ";
            one.value.write(out, indent, depth + 1);
        }
        if (!object.empty()) next_line(depth);
        out += '}';
    }
}

std::string Json::dump(int indent) const {
    std::string out;
    write(out, indent, 0);
    return out;
}

}  // namespace regather::trace
