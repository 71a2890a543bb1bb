#include "imports/scene_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <stdlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>

#include "trace/error.h"
#include "trace/file.h"
#include "trace/json.h"
#include "trace/text.h"

namespace regather::imports {

using trace::DataError;
using trace::UsageError;

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

std::string text_of(std::string_view text) {
    return trace::Json(text).dump();
}

std::string text_of(Vec3 v) {
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

// Every number of the file goes through here: JSON has no NaN.
class Checked {
public:
    explicit Checked(const std::string& scene) : scene_(scene) {}

    [[noreturn]] void fail(std::string_view field, std::string_view found, std::string_view expected) const {
        throw DataError(fmt::format("{}: {}: found {}, expected {}", scene_, field, found, expected));
    }
    std::string operator()(std::string_view field, Vec3 v) const {
        if (!trace::is_finite(v))
            fail(field, fmt::format("({}, {}, {})", v.x, v.y, v.z), "three finite numbers");
        return text_of(v);
    }
    std::string operator()(std::string_view field, float v) const {
        if (!std::isfinite(v)) fail(field, fmt::format("{}", v), "a finite number");
        return fmt::format("{}", v);
    }

private:
    const std::string& scene_;
};

template <class T>
void put(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

bool has_normals(const Surface& surface) {
    return surface.normals.size() == surface.vertices.size() &&
           std::any_of(surface.normals.begin(), surface.normals.end(), [](Vec3 n) { return n != Vec3{}; });
}

std::string ply_of(const Surface& surface) {
    const bool normals = has_normals(surface);
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
        "y\nproperty float z\n"
        "{}element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        surface.vertices.size(), normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        surface.triangles.size());
    bytes.reserve(bytes.size() + surface.vertices.size() * 24 + surface.triangles.size() * 13);
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        put(bytes, surface.vertices[v]);
        if (normals) put(bytes, surface.normals[v]);
    }
    for (const auto& triangle : surface.triangles) {
        bytes += '\3';
        put(bytes, triangle);
    }
    return bytes;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "\n  " : ",\n  ") + line;
    return text + "\n";
}

void append(Surface& all, const Surface& part) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.normals.resize(all.vertices.size());
    for (const auto& [a, b, c] : part.triangles) all.triangles.push_back({first + a, first + b, first + c});
}

class SceneWriter {
public:
    SceneWriter(const ImportedScene& scene, const fs::path& folder)
        : scene_(scene), folder_(folder), checked_(scene.name) {}

    void write() {
        check_names();
        std::string json = "{\n";
        json += fmt::format("\"name\": {},\n", text_of(scene_.name));
        if (!scene_.origin.empty()) json += fmt::format("\"origin\": {},\n", text_of(scene_.origin));
        if (!scene_.licence.empty()) json += fmt::format("\"licence\": {},\n", text_of(scene_.licence));
        json += camera() + camera_path();
        json += section("materials", '{', materials(), '}') + ",\n";
        json += section("shapes", '[', shapes(), ']') + ",\n";
        json += section("lights", '[', lights(), ']') + "\n}\n";
        trace::write_whole(folder_ / "scene.json", json);  // last: without it the folder is no scene
    }

private:
    static std::string section(std::string_view key, char open, const std::vector<std::string>& lines,
                               char close) {
        return fmt::format("\n\"{}\": {}{}{}", key, open, joined(lines), close);
    }

    void check_names() const {
        if (scene_.name != plain_name(scene_.name))
            checked_.fail("name", text_of(scene_.name), "1 to 64 letters, digits, '_', '-' or '.'");
        std::set<std::string_view> names;
        for (const Material& material : scene_.materials)
            if (material.name.empty() || !names.insert(material.name).second)
                checked_.fail("materials", fmt::format("{} twice or empty", text_of(material.name)),
                              "names that differ");
    }

    std::string camera() const {
        const Camera& camera = scene_.camera;
        return fmt::format(
            R"("camera": {{"position": {}, "target": {}, "up": {}, "vertical_fov_degrees": {}}},)"
            "\n",
            checked_("camera.position", camera.position), checked_("camera.target", camera.target),
            checked_("camera.up", camera.up),
            checked_("camera.vertical_fov_degrees", camera.vertical_fov_degrees));
    }

    std::string camera_path() const {
        if (scene_.camera_path.empty()) return "";
        std::vector<std::string> lines;
        for (const KeyFrame& key : scene_.camera_path)
            lines.push_back(fmt::format(R"({{"frame": {}, "position": {}, "target": {}, "up": {}}})",
                                        key.frame, checked_("camera_path.position", key.position),
                                        checked_("camera_path.target", key.target),
                                        checked_("camera_path.up", key.up)));
        return fmt::format("\"camera_path\": {{\"frames\": {}, \"keys\": [{}]}},\n", scene_.frames,
                           joined(lines));
    }

    std::vector<std::string> materials() const {
        std::vector<std::string> lines;
        for (const Material& material : scene_.materials) {
            const std::string field = "materials." + material.name;
            const std::string diffuse = checked_(field, material.diffuse),
                              specular = checked_(field, material.specular);
            std::string body;
            switch (material.kind) {
                case MaterialKind::diffuse:
                    body = fmt::format(R"("diffuse", "diffuse": {})", diffuse);
                    break;
                case MaterialKind::glossy:
                    body = fmt::format(R"("glossy", "diffuse": {}, "specular": {}, "exponent": {})", diffuse,
                                       specular, checked_(field, material.exponent));
                    break;
                case MaterialKind::mirror:
                    body = fmt::format(R"("mirror", "specular": {})", specular);
                    break;
                case MaterialKind::dielectric:
                    body = fmt::format(R"("dielectric", "index_of_refraction": {})",
                                       checked_(field, material.index_of_refraction));
                    break;
            }
            lines.push_back(fmt::format(R"({}: {{"kind": {}}})", text_of(material.name), body));
        }
        return lines;
    }

    std::vector<std::string> shapes() {
        std::vector<Surface> by_material(scene_.materials.size());
        for (const ImportedMesh& mesh : scene_.meshes) {
            if (mesh.material >= by_material.size())
                checked_.fail("meshes", fmt::format("material {}", mesh.material),
                              fmt::format("one of {}", by_material.size()));
            append(by_material[mesh.material], mesh.surface);
        }
        std::vector<std::string> lines;
        for (std::size_t m = 0; m < by_material.size(); ++m) {
            const std::string file =
                write_mesh(by_material[m], fmt::format("{:03}_{}", m, scene_.materials[m].name));
            if (file.empty()) continue;
            lines.push_back(fmt::format(R"({{"type": "mesh", "file": {}, "material": {}}})", text_of(file),
                                        text_of(scene_.materials[m].name)));
        }
        return lines;
    }

    // The file's name below the folder; "" when nothing is left to write.
    std::string write_mesh(Surface& surface, const std::string& name) const {
        for (const Vec3 p : surface.vertices)
            if (!trace::is_finite(p)) checked_.fail(name, "a vertex that is not finite", "numbers");
        drop_degenerate(surface);
        if (surface.triangles.empty()) return "";
        const std::string file = fmt::format("meshes/{}.ply", plain_name(name));
        trace::write_whole(folder_ / file, ply_of(surface));
        return file;
    }

    std::vector<std::string> lights() const {
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const ImportedLight& light = scene_.lights[i];
            const std::string field = fmt::format("lights[{}]", i);
            std::string body;
            if (light.shape == ImportedLight::Shape::rectangle) {
                body =
                    fmt::format(R"("corner": {}, "edge_u": {}, "edge_v": {})", checked_(field, light.corner),
                                checked_(field, light.edge_u), checked_(field, light.edge_v));
            } else if (light.shape == ImportedLight::Shape::sphere) {
                body =
                    fmt::format(R"("type": "sphere", "center": {}, "radius": {}, "segments": {})",
                                checked_(field, light.center), checked_(field, light.radius), light.segments);
            } else {
                Surface surface = light.surface;
                const std::string file = write_mesh(surface, fmt::format("light_{:03}", i));
                if (file.empty()) continue;
                body = fmt::format(R"("type": "mesh", "file": {})", text_of(file));
            }
            const bool by_power = light.power != Vec3{};
            if (by_power == (light.radiance != Vec3{}))
                checked_.fail(field, by_power ? "both power and radiance" : "neither power nor radiance",
                              "one of them");
            body += fmt::format(R"(, "{}": {})", by_power ? "power" : "radiance",
                                checked_(field, by_power ? light.power : light.radiance));
            if (light.material >= 0)
                body +=
                    fmt::format(R"(, "material": {})",
                                text_of(scene_.materials.at(static_cast<std::size_t>(light.material)).name));
            lines.push_back("{" + body + "}");
        }
        return lines;
    }

    const ImportedScene& scene_;
    fs::path folder_;
    Checked checked_;
};

// A folder beside `folder` that is gone with the object, unless it was renamed.
class FolderBeside {
public:
    explicit FolderBeside(const fs::path& folder) {
        if (folder.has_parent_path()) fs::create_directories(folder.parent_path());
        std::string pattern = folder.string() + ".partial-XXXXXX";
        if (!::mkdtemp(pattern.data()))
            throw std::runtime_error(
                fmt::format("{}: cannot create a folder: {}", pattern, std::strerror(errno)));
        path_ = pattern;
        fs::permissions(
            path_,
            fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
            fs::perm_options::add);
    }
    ~FolderBeside() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    FolderBeside(const FolderBeside&) = delete;
    FolderBeside& operator=(const FolderBeside&) = delete;

    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

fs::path without_trailing_slash(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace

std::uint64_t ImportedScene::triangle_count() const {
    std::uint64_t count = 0;
    for (const ImportedMesh& mesh : meshes) count += mesh.surface.triangles.size();
    return count;
}

std::string plain_name(std::string_view text) {
    std::string name(text.substr(0, 64));
    for (char& c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '_' || c == '-' || c == '.';
        if (!plain) c = '_';
    }
    return name.empty() ? "unnamed" : name;
}

void check_scene_folder(const fs::path& folder, bool force) {
    const fs::path target = without_trailing_slash(folder);
    std::error_code error;
    if (target.empty())
        throw UsageError("found an empty folder name, expected a folder to write the scene to");
    if (!fs::exists(fs::symlink_status(target, error))) return;
    if (!fs::is_directory(fs::symlink_status(target, error)))
        throw UsageError(fmt::format("{}: found a file, expected a folder to write the scene to",
                                     trace::shown(target.string(), trace::most_shown_path)));
    if (fs::is_empty(target, error)) return;
    if (!force)
        throw UsageError(
            fmt::format("{}: found a folder that is not empty, expected another one (or --force)",
                        trace::shown(target.string(), trace::most_shown_path)));
    for (const fs::directory_entry& entry : fs::directory_iterator(target)) {
        const std::string name = entry.path().filename().string();
        if (name != "scene.json" && name != "meshes")
            throw UsageError(
                fmt::format("{}: found {}, which is not of an imported scene, expected a folder that may go",
                            trace::shown(target.string(), trace::most_shown_path), trace::in_quotes(name)));
    }
}

void write_scene(const ImportedScene& scene, const fs::path& folder, bool force) {
    check_scene_folder(folder, force);
    const fs::path target = without_trailing_slash(folder);
    const FolderBeside partial(target);
    SceneWriter(scene, partial.path()).write();
    if (!fs::exists(target)) {
        fs::rename(partial.path(), target);
        return;
    }
    // The two change places at once where the file system can; the previous scene goes with `partial`.
    if (::renameat2(AT_FDCWD, partial.path().c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return;
    fs::remove_all(target);
    fs::rename(partial.path(), target);
}

}  // namespace regather::imports
