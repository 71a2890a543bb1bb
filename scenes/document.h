// scenes/document.h -- a JSON scene file, read strictly: every value knows where it stands, so that each
// refusal is one line "FILE: FIELD: found X, expected Y" (trace::DataError).
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/keys.h"
#include "trace/vec.h"

namespace regather::scenes {

/// A JSON value and its path ("shapes[3].radius"). Valid as long as its Document.
class Node {
public:
    Node(const nlohmann::json& value, std::string path, const std::string& file)
        : value_(&value), path_(std::move(path)), file_(&file) {}

    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;

    /// Refuses anything but an object that has all required keys of `kind` and none beyond its keys.
    void check_object(const Kind& kind, std::string_view noun = "") const;
    /// Which of `kinds` this object is by its text at `discriminator`; checked like check_object. `noun`:
    /// "shape". Without the discriminator it is of kind `otherwise`, if there is one.
    const Kind& check_object(std::span<const Kind> kinds, std::string_view discriminator,
                             std::string_view noun, const Kind* otherwise = nullptr) const;

    bool has(std::string_view key) const;
    Node operator[](std::string_view key) const;  ///< A key that is there.
    std::vector<Node> elements(std::string_view expected) const;
    std::vector<std::pair<std::string, Node>> members(std::string_view expected) const;

    const std::string& text(std::string_view expected) const;
    /// Finite and low <= x <= high; `open`: low < x < high.
    enum class Ends { closed, open, open_low };
    double number(double low, double high, std::string_view expected, Ends ends = Ends::closed) const;
    std::uint32_t whole(std::uint32_t low, std::uint32_t high, std::string_view expected) const;
    bool truth(std::string_view expected) const;
    std::array<double, 3> numbers(double low, double high, std::string_view expected) const;
    trace::Vec3 triple(double low, double high, std::string_view expected) const;

private:
    std::string found() const;
    Node element(std::size_t i) const;

    const nlohmann::json* value_;
    std::string path_;
    const std::string* file_;
};

/// Of any text: one line, in quotes, shortened.
std::string in_quotes(std::string_view text);

class Document {
public:
    /// Refuses syntax errors with line and column, and objects that have a key twice.
    Document(std::string_view text, std::string file);
    ~Document();

    Node root() const;

private:
    std::string file_;
    std::unique_ptr<nlohmann::json> root_;
};

}  // namespace regather::scenes
