// tests/scenes/scene_text.h -- small scene files as text, with one part replaced at a time.
#pragma once
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>

#include "scenes/loader.h"
#include "trace/error.h"

namespace regather::scenes {

struct SceneText {
    std::string name = R"("t")";
    std::string camera =
        R"({"position": [0, -3, 1], "target": [0, 0, 1], "up": [0, 0, 1], "vertical_fov_degrees": 50})";
    std::string materials = R"("white": {"kind": "diffuse", "diffuse": [0.5, 0.5, 0.5]})";
    std::string shapes =
        R"({"type": "quad", "material": "white", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]})";
    std::string lights{};

    std::string text() const {
        return R"({"name": )" + name + R"(, "camera": )" + camera + R"(, "materials": {)" + materials +
               R"(}, "shapes": [)" + shapes + R"(], "lights": [)" + lights + "]}";
    }
};

inline Scene parse(const std::string& text) {
    return parse_scene(text, "t.json", {});
}

/// The message of the DataError that the text is refused with, less the line of a value, which is where
/// SceneText happens to place it; "" when it is not.
inline std::string refusal(const std::string& text, const std::filesystem::path& directory = {}) {
    try {
        parse_scene(text, "t.json", directory);
    } catch (const trace::DataError& error) {
        return std::regex_replace(error.what(), std::regex(R"(: line \d+, (?!column))"), ": ");
    }
    return "";
}

/// A folder that is gone with the object.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "regather_scenes_XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::ofstream(path_ / name, std::ios::binary)
            .write(content.data(), static_cast<std::streamsize>(content.size()));
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

}  // namespace regather::scenes
