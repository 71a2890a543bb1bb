#include "imports/maps/shader_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::imports {

using trace::in_quotes;

namespace {

constexpr std::size_t most_names = 100, most_name_bytes = 64;
constexpr std::array<std::string_view, 7> used_parms{"sky",   "nodraw", "fog",   "water",
                                                     "slime", "lava",   "portal"};

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\0';
}

// Lines of words; braces are words of their own.
class Lines {
public:
    explicit Lines(std::string_view text) : rest_(text) {}

    /// The words of the next line, or none at the end.
    std::optional<std::vector<std::string_view>> next() {
        if (rest_.empty()) return std::nullopt;
        ++number_;
        std::vector<std::string_view> words;
        while (!rest_.empty()) {
            if (rest_.front() == '\n') {
                rest_.remove_prefix(1);
                break;
            }
            if (in_comment_) {
                in_comment_ = !rest_.starts_with("*/");
                rest_.remove_prefix(in_comment_ ? 1 : 2);
            } else if (rest_.starts_with("//")) {
                rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
            } else if (rest_.starts_with("/*")) {
                in_comment_ = true;
                rest_.remove_prefix(2);
            } else if (is_blank(rest_.front())) {
                rest_.remove_prefix(1);
            } else {
                words.push_back(word());
            }
        }
        return words;
    }
    std::size_t number() const { return number_; }

private:
    std::string_view word() {
        std::size_t end = 0;
        if (rest_[0] == '{' || rest_[0] == '}') {
            end = 1;
        } else {
            while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != '\n' && rest_[end] != '{' &&
                   rest_[end] != '}' && rest_.substr(end, 2) != "//" && rest_.substr(end, 2) != "/*")
                ++end;
        }
        std::string_view result = rest_.substr(0, end);
        rest_.remove_prefix(end);
        if (result.size() >= 2 && result.front() == '"' && result.back() == '"')
            result = result.substr(1, result.size() - 2);
        return result;
    }

    std::string_view rest_;
    std::size_t number_ = 0;
    bool in_comment_ = false;
};

class Parser {
public:
    Parser(std::string_view text, std::string_view file) : lines_(text), file_(file) {}

    std::vector<ShaderScript> parse() {
        while (const auto words = lines_.next()) {
            std::size_t i = 0;
            while (i < words->size()) {
                const std::string_view word = (*words)[i];
                if (word == "{" || word == "}") {
                    brace(word == "{");
                    ++i;
                } else if (depth_ == 0) {
                    if (name_line_ != 0)
                        refuse(in_quotes(word), fmt::format("{{ after the name in line {}", name_line_));
                    shaders_.emplace_back().name = word;
                    name_line_ = lines_.number();
                    ++i;
                } else {
                    const auto end =
                        std::find_if(words->begin() + static_cast<std::ptrdiff_t>(i), words->end(),
                                     [](std::string_view w) { return w == "{" || w == "}"; });
                    const auto last = static_cast<std::size_t>(end - words->begin());
                    directive({words->begin() + static_cast<std::ptrdiff_t>(i), end});
                    i = last;
                }
            }
        }
        if (depth_ > 0) refuse("the end", "}");
        if (name_line_ != 0) refuse("the end", fmt::format("{{ after the name in line {}", name_line_));
        return std::move(shaders_);
    }

private:
    [[noreturn]] void refuse(std::string_view found, std::string_view expected) const {
        throw trace::DataError(
            fmt::format("{}: line {}: found {}, expected {}", file_, lines_.number(), found, expected));
    }

    void brace(bool opens) {
        if (opens) {
            if (depth_ == 0 && name_line_ == 0) refuse("{", "the name of a shader before it");
            if (depth_ == 2) refuse("{", "a stage without another inside");
            name_line_ = 0;
            ++depth_;
            if (depth_ == 2) ++stages_;
            if (depth_ == 1) stages_ = 0;
        } else {
            if (depth_ == 0) refuse("}", "the name of a shader");
            --depth_;
        }
    }

    // What is no number counts as 0, as in the engine; OpenArena's own scripts have such lines.
    static double number(const std::vector<std::string_view>& words, std::size_t i) {
        if (i >= words.size()) return 0;
        std::string_view word = words[i];
        if (word.starts_with('+')) word.remove_prefix(1);
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc{} && std::isfinite(value) ? value : 0;
    }

    static trace::Vec3 colour(const std::vector<std::string_view>& words, std::size_t first) {
        trace::Vec3 result;
        for (int axis = 0; axis < 3; ++axis)
            result[axis] = static_cast<float>(
                std::clamp(number(words, first + static_cast<std::size_t>(axis)), 0.0, 1e6));
        return result;
    }

    void directive(const std::vector<std::string_view>& words) {
        ShaderScript& shader = shaders_.back();
        const std::string key = lower(words[0]);
        const std::string value = words.size() > 1 ? lower(words[1]) : "";
        if (!(depth_ == 1 ? of_surface(shader, key, value, words) : of_stage(shader, key, value, words)))
            leave_out(shader, key);
    }

    // False for what is not used.
    static bool of_surface(ShaderScript& shader, const std::string& key, const std::string& value,
                           const std::vector<std::string_view>& words) {
        if ((key == "surfaceparm" || key == "sort") && value == "portal") shader.portal = true;
        if (key == "surfaceparm") {
            shader.surface_parms.push_back(value);
            if (std::find(used_parms.begin(), used_parms.end(), value) == used_parms.end())
                leave_out(shader, key + " " + value);
        } else if (key == "q3map_surfacelight") {
            shader.surface_light = std::clamp(number(words, 1), 0.0, 1e9);
        } else if (key == "q3map_lightimage") {
            shader.light_image = value;
        } else if (key == "qer_editorimage") {
            shader.editor_image = value;
        } else if (key == "q3map_lightrgb") {
            shader.light_colour = colour(words, 1);
        } else if (key == "q3map_sun" || key == "sun" || key == "q3map_sunext") {
            shader.sun_colour = colour(words, 1);
            shader.sun_intensity = std::clamp(number(words, 4), 0.0, 1e9);
        } else {
            return key == "sort" && value == "portal";
        }
        return true;
    }

    bool of_stage(ShaderScript& shader, const std::string& key, const std::string& value,
                  const std::vector<std::string_view>& words) const {
        if (key == "map" || key == "clampmap" || key == "animmap") {
            const std::size_t at = key == "animmap" ? 2 : 1;
            if (words.size() > at && shader.map.empty() && !words[at].starts_with('$'))
                shader.map = lower(words[at]);
        } else if (key == "tcgen" && value == "environment") {
            shader.environment = true;
        } else if (key == "alphafunc") {
            shader.alpha_tested = true;
        } else if (key == "blendfunc") {
            if (stages_ == 1) shader.see_through = value != "filter" && value != "gl_dst_color";
        } else {
            return false;
        }
        return true;
    }

    static void leave_out(ShaderScript& shader, std::string name) {
        if (name.size() > most_name_bytes) name.resize(most_name_bytes);
        if (shader.left_out.size() >= most_names && !shader.left_out.contains(name))
            name = "other directives";
        ++shader.left_out[name];
    }

    Lines lines_;
    std::string_view file_;
    std::vector<ShaderScript> shaders_;
    int depth_ = 0, stages_ = 0;
    std::size_t name_line_ = 0;  // Of a name whose brace has not come yet; 0: none.
};

}  // namespace

bool ShaderScript::has_parm(std::string_view parm) const {
    return std::find(surface_parms.begin(), surface_parms.end(), parm) != surface_parms.end();
}

std::vector<ShaderScript> read_shader_scripts(std::string_view text, std::string_view file) {
    return Parser(text, file).parse();
}

}  // namespace regather::imports
