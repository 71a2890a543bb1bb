#include "meshes/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "meshes/number.h"
#include "meshes/text_lines.h"
#include "trace/text.h"

namespace regather::meshes {

namespace {

constexpr std::string_view not_read_as_spectra = "colours given as spectra or in CIE XYZ are not read";

bool is_map(std::string_view keyword) {
    return keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" || keyword == "decal" ||
           keyword == "refl" || keyword == "norm";
}

// Terms that numbers alone follow.
bool is_number_term(std::string_view keyword) {
    constexpr std::array<std::string_view, 10> terms{"ka", "kd", "ks", "ke", "tf",
                                                     "ns", "ni", "d",  "tr", "illum"};
    return std::find(terms.begin(), terms.end(), keyword) != terms.end();
}

// The file's name of a map: what follows its options.
std::string_view map_file(TextLines& line) {
    // Options with one word as a value; the values of the others are numbers, up to three.
    constexpr std::array<std::string_view, 6> with_word{"-blendu", "-blendv",  "-cc",
                                                        "-clamp",  "-imfchan", "-type"};
    while (line.rest().starts_with('-')) {
        const std::string_view option = line.word();
        if (std::find(with_word.begin(), with_word.end(), option) != with_word.end()) {
            line.word();
            continue;
        }
        for (int i = 0; i < 3; ++i) {
            const std::string_view rest = line.rest();
            if (!real_number(rest.substr(0, rest.find_first_of(" \t")))) break;
            line.word();
        }
    }
    return line.rest();
}

class Library {
public:
    Library(std::string_view bytes, const std::string& file, Notes& notes)
        : line_(bytes, file), notes_(notes) {}

    std::vector<Material> read() {
        while (line_.next()) {
            if (line_.keyword() == "newmtl") {
                finish();
                begin();
            } else if (materials_.empty()) {
                line_.fail(in_quotes(line_.keyword()) + " before the first newmtl", "newmtl");
            } else {
                read_term(line_.keyword());
                if (!line_.rest().empty() && is_number_term(line_.keyword()))
                    notes_.add(fmt::format("words behind the numbers of the material term {} are not read",
                                           in_quotes(line_.keyword())));
            }
        }
        finish();
        return std::move(materials_);
    }

private:
    static std::string in_quotes(std::string_view text) { return trace::in_quotes(text); }

    void begin() {
        std::string_view name = line_.rest();
        if (name.size() > 1 && name.front() == '"' && name.back() == '"')
            name = name.substr(1, name.size() - 2);
        if (name.empty()) line_.fail("newmtl without a name", "newmtl NAME");
        materials_.push_back({.name = std::string(name), .terms = MtlTerms{}, .emission = {}});
        terms_ = {};
        opacity_ = transparency_ = std::nullopt;
    }

    void finish() {
        if (materials_.empty()) return;
        if (opacity_ || transparency_) terms_.d = opacity_ ? *opacity_ : 1 - *transparency_;
        if (opacity_ && transparency_ && std::abs(*opacity_ + *transparency_ - 1) > 1e-3f)
            notes_.add("materials whose d and Tr contradict each other are read by d");
        materials_.back().terms = terms_;
        if (materials_.back().emission != Vec3{}) notes_.add("materials that emit light (Ke) do not shine");
    }

    void read_term(std::string_view keyword) {
        if (keyword == "kd") {
            read_colour(terms_.kd);
        } else if (keyword == "ks") {
            read_colour(terms_.ks);
        } else if (keyword == "ke") {
            read_colour(materials_.back().emission);
        } else if (keyword == "tf") {
            Vec3 filter{1, 1, 1};
            read_colour(filter);
            if (filter != Vec3{1, 1, 1}) notes_.add("colours of transmitted light (Tf) are not read");
        } else if (keyword == "ns") {
            terms_.ns = number();
        } else if (keyword == "ni") {
            terms_.ni = number();
        } else if (keyword == "illum") {
            const float model = number();
            if (model != std::floor(model) || model < 0 || model > 10)
                line_.fail(fmt::format("illum {}", model), "a whole number from 0 to 10");
            terms_.illum = static_cast<int>(model);
        } else if (keyword == "d") {
            if (line_.rest().starts_with("-halo")) {
                line_.word();
                notes_.add("opacities that depend on the view (d -halo) are read as even ones");
            }
            opacity_ = number();
        } else if (keyword == "tr") {
            transparency_ = number();
        } else if (is_map(keyword)) {
            read_map(keyword);
        } else if (keyword == "ka") {
            Vec3 ambient;
            read_colour(ambient);
            if (ambient != Vec3{}) notes_.add("ambient colours (Ka) are not read");
        } else {
            notes_.add(fmt::format("the material term {} is not read", in_quotes(keyword)));
        }
    }

    void read_map(std::string_view keyword) {
        const std::string kind =
            fmt::format("textures ({}) are not read", keyword == "map_kd" ? "map_Kd" : keyword);
        const std::string_view file = map_file(line_);
        if (keyword == "map_kd") materials_.back().texture = std::string(file);
        notes_.add(kind);
    }

    float number() {
        const std::string_view word = line_.word();
        const std::optional<float> value = finite_float(word);
        if (!value)
            line_.fail(word.empty() ? "a term without its number" : in_quotes(word), "a finite number");
        return *value;
    }

    // One number stands for all three channels.
    void read_colour(Vec3& colour) {
        if (line_.rest().starts_with("spectral") || line_.rest().starts_with("xyz")) {
            notes_.add(not_read_as_spectra);
            while (!line_.word().empty()) {
            }
            return;
        }
        colour.x = number();
        if (line_.rest().empty()) {
            colour.y = colour.z = colour.x;
            return;
        }
        colour.y = number();
        colour.z = number();
    }

    TextLines line_;
    Notes& notes_;
    std::vector<Material> materials_;
    MtlTerms terms_;
    std::optional<float> opacity_, transparency_;
};

}  // namespace

std::vector<Material> read_mtl(std::string_view bytes, const std::string& file, Notes& notes) {
    return Library(bytes, file, notes).read();
}

}  // namespace regather::meshes
