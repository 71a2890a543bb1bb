#include "imports/maps/openarena.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "imports/maps/bsp.h"
#include "imports/maps/entity_keys.h"
#include "imports/maps/light_cluster.h"
#include "imports/maps/map_material.h"
#include "imports/maps/patch.h"
#include "imports/maps/pk3.h"
#include "imports/maps/shader_script.h"
#include "imports/maps/tour.h"
#include "imports/texture_colour.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::imports {

using trace::in_quotes;

namespace {

constexpr std::uint64_t most_map_bytes = 256 << 20, most_script_bytes = 16 << 20, most_image_bytes = 64 << 20;
constexpr std::uint64_t most_triangles = 4'000'000;
constexpr std::size_t most_entity_lights = 10'000, most_surface_lights = 200;
constexpr double most_tour_metres = 60;
// q3map: light N has 7500 N in the light map's units over the squared distance in game units (its
// pointScale); the scale of map_radiance.
constexpr double watts_a_light_unit = 4 * 3.14159265358979 * 3.14159265358979 * 7500 / light_map_white *
                                      double{metres_a_game_unit} * double{metres_a_game_unit};
constexpr float entity_light_radius = 0.1f;

std::vector<std::string> map_names(const Pk3Archives& archives) {
    std::vector<std::string> result;
    for (const std::string& name : archives.names("maps/", ".bsp"))
        result.push_back(name.substr(5, name.size() - 9));
    return result;
}

std::string entry_of_map(const Pk3Archives& archives, const std::string& map) {
    const std::string entry = "maps/" + lower_case(map) + ".bsp";
    if (!map.empty() && archives.has(entry)) return entry;
    const auto names = map_names(archives);
    if (names.empty()) throw trace::UsageError("map: found no maps/*.bsp in the archives given");
    const std::vector<std::string_view> views(names.begin(), names.end());
    if (map.empty())
        throw trace::UsageError(fmt::format("map: none is named, expected one of {}", trace::listed(views)));
    throw trace::UsageError(fmt::format("map: found {}, expected one of {}; nearest: {}", in_quotes(map),
                                        trace::listed(views),
                                        trace::alternatives(trace::nearest_words(lower_case(map), views))));
}

// Mean colours of images, each read once.
class Colours {
public:
    explicit Colours(const Pk3Archives& archives) : archives_(archives) {}

    /// As the game looks for it: whatever ending it is named with, .tga, .jpg or .png is taken.
    std::optional<Vec3> of(std::string name) {
        name = lower_case(name);
        for (const std::string_view ending : {".tga", ".jpg", ".jpeg", ".png"})
            if (name.ends_with(ending)) name.erase(name.size() - ending.size());
        if (name.empty()) return std::nullopt;
        if (const auto known = known_.find(name); known != known_.end()) return known->second;
        for (const std::string_view ending : {".tga", ".jpg", ".jpeg", ".png"}) {
            const std::string entry = name + std::string(ending);
            if (archives_.has(entry))
                return known_[name] =
                           mean_colour(archives_.read(entry, most_image_bytes), archives_.place(entry));
        }
        return known_[name] = std::nullopt;
    }

private:
    const Pk3Archives& archives_;
    std::map<std::string, std::optional<Vec3>> known_;
};

std::map<std::string, ShaderScript> read_scripts(const Pk3Archives& archives) {
    std::map<std::string, ShaderScript> scripts;
    for (const std::string& entry : archives.names("scripts/", ".shader")) {
        const auto bytes = archives.read(entry, most_script_bytes);
        for (ShaderScript& script : read_shader_scripts(
                 {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, archives.place(entry)))
            scripts[lower_case(script.name)] = std::move(script);
    }
    return scripts;
}

void append(Surface& to, const Surface& from) {
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
    to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
    for (const auto& [a, b, c] : from.triangles) to.triangles.push_back({first + a, first + b, first + c});
}

Vec3 unit_or_zero(Vec3 v) {
    const float size = length(v);
    return size > 0 ? v * (1 / size) : Vec3{};
}

// The winding follows the vertices' normals.
Surface flat_surface(const Bsp& bsp, const BspFace& face) {
    Surface surface;
    for (std::uint32_t i = 0; i < face.vertex_count; ++i) {
        const BspVertex& vertex = bsp.vertices[face.first_vertex + i];
        surface.vertices.push_back(vertex.position);
        surface.normals.push_back(unit_or_zero(vertex.normal));
    }
    for (std::uint32_t i = 0; i < face.index_count; i += 3) {
        const std::uint32_t* at = &bsp.indices[face.first_index + i];
        std::array<std::uint32_t, 3> triangle{at[0], at[1], at[2]};
        const auto& v = surface.vertices;
        const Vec3 normal = cross(v[at[1]] - v[at[0]], v[at[2]] - v[at[0]]);
        const Vec3 outside = surface.normals[at[0]] + surface.normals[at[1]] + surface.normals[at[2]];
        if (dot(normal, outside) < 0) std::swap(triangle[1], triangle[2]);
        surface.triangles.push_back(triangle);
    }
    return surface;
}

Surface curved_surface(const Bsp& bsp, const BspFace& face, std::uint32_t subdivision) {
    ControlNet net{face.patch_width, face.patch_height, {}, {}};
    for (std::uint32_t i = 0; i < face.vertex_count; ++i) {
        net.points.push_back(bsp.vertices[face.first_vertex + i].position);
        net.normals.push_back(bsp.vertices[face.first_vertex + i].normal);
    }
    return tessellate(net, subdivision);
}

std::uint64_t triangle_count(const BspFace& face, std::uint32_t subdivision) {
    if (face.kind == BspFace::Kind::patch)
        return triangle_count(ControlNet{face.patch_width, face.patch_height, {}, {}}, subdivision);
    return face.index_count / 3;
}

// Where moving parts stand: their model's coordinates are about the entity's origin.
std::vector<Vec3> model_origins(const Bsp& bsp) {
    std::vector<Vec3> origins(bsp.models.size());
    for (const BspEntity& entity : bsp.entities) {
        const std::string_view model = entity.value("model");
        std::size_t index = 0;
        if (!model.starts_with('*')) continue;
        std::from_chars(model.data() + 1, model.data() + model.size(), index);
        if (index > 0 && index < origins.size())
            origins[index] = triple_in(entity.value("origin")).value_or(Vec3{});
    }
    return origins;
}

class Importer {
public:
    Importer(const Pk3Archives& archives, const Bsp& bsp, const OpenArenaOptions& options)
        : bsp_(bsp), options_(options), colours_(archives), scripts_(read_scripts(archives)) {}

    ImportedScene import(std::string name) {
        result_.name = plain_name(name);
        sort_textures();
        collect_faces();
        add_surface_lights();
        add_entity_lights();
        add_meshes();
        add_tour(name);
        add_left_out();
        return std::move(result_);
    }

private:
    struct Texture {
        MapSurface surface = MapSurface::open;
        double radiance = 0;
        std::size_t group = 0;
        const ShaderScript* script = nullptr;
    };
    struct Group {  // Faces of one texture name.
        std::size_t texture = 0;
        Surface surface;
    };

    void sort_textures() {
        std::map<std::string, std::size_t> group_of;
        for (const BspTexture& texture : bsp_.textures) {
            const auto found = scripts_.find(lower_case(texture.name));
            Texture& sorted = textures_.emplace_back();
            sorted.script = found == scripts_.end() ? nullptr : &found->second;
            sorted.surface = map_surface(texture, sorted.script);
            sorted.radiance = map_radiance(texture, sorted.script);
            const auto [group, is_first] = group_of.emplace(lower_case(texture.name), groups_.size());
            sorted.group = group->second;
            if (is_first) groups_.push_back({textures_.size() - 1, {}});
        }
    }

    void collect_faces() {
        std::uint64_t total = 0, patches = 0, curved = 0, billboards = 0, left_out = 0;
        const std::vector<Vec3> origins = model_origins(bsp_);
        for (std::size_t m = 0; m < bsp_.models.size(); ++m) {
            const BspModel& model = bsp_.models[m];
            for (std::uint32_t f = 0; f < model.face_count; ++f) {
                const BspFace& face = bsp_.faces[model.first_face + f];
                const Texture& texture = textures_[face.texture];
                const std::uint64_t count = triangle_count(face, options_.subdivision);
                const bool fog = (bsp_.textures[face.texture].contents & BspTexture::fog) != 0;
                const bool lit = texture.radiance > 0 && !fog;
                if (face.kind == BspFace::Kind::billboard) {
                    ++billboards;
                } else if (texture.surface != MapSurface::solid && !lit) {
                    left_out += count;
                } else {
                    if ((total += count) > most_triangles)
                        throw trace::DataError(
                            fmt::format("{}: faces: found more than {} triangles, expected fewer",
                                        options_.map, most_triangles));
                    const bool is_patch = face.kind == BspFace::Kind::patch;
                    if (is_patch) ++patches, curved += count;
                    Surface surface = is_patch ? curved_surface(bsp_, face, options_.subdivision)
                                               : flat_surface(bsp_, face);
                    for (Vec3& vertex : surface.vertices) vertex += origins[m];
                    append(groups_[texture.group].surface, surface);
                }
            }
        }
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            const auto& vertices = groups_[g].surface.vertices;
            for (const auto& [a, b, c] : groups_[g].surface.triangles) {
                triangles_.push_back({vertices[a], vertices[b], vertices[c]});
                texture_of_triangle_.push_back(static_cast<std::uint32_t>(g));
            }
        }
        note("{} triangles, {} of them from {} curved patches ({} steps a side)", total, curved, patches,
             options_.subdivision);
        note("left out: {} triangles that are seen through or never drawn, {} billboards", left_out,
             billboards);
    }

    template <class... Values>
    void note(fmt::format_string<Values...> form, Values&&... values) {
        result_.notes.push_back(fmt::format(form, std::forward<Values>(values)...));
    }

    std::optional<Vec3> texture_colour(std::size_t texture) {
        const ShaderScript* script = textures_[texture].script;
        if (script != nullptr && !script->map.empty())
            if (const auto colour = colours_.of(script->map)) return colour;
        if (const auto colour = colours_.of(bsp_.textures[texture].name)) return colour;
        return script == nullptr ? std::nullopt : colours_.of(script->editor_image);
    }

    // Its brightest channel is 1.
    Vec3 light_colour(std::size_t texture) {
        const ShaderScript* script = textures_[texture].script;
        Vec3 colour{1, 1, 1};
        if (script != nullptr && script->light_colour) {
            colour = *script->light_colour;
        } else {
            std::optional<Vec3> found;
            if (script != nullptr) found = colours_.of(script->light_image);
            if (!found) found = texture_colour(texture);
            if (!found && script != nullptr && script->sun_intensity > 0) found = script->sun_colour;
            // As q3map takes it: the texels as they are stored.
            if (found)
                for (int axis = 0; axis < 3; ++axis) colour[axis] = std::pow((*found)[axis], 1 / 2.2f);
        }
        const float brightest = trace::max_component(colour);
        return brightest > 0 ? colour * (1 / brightest) : Vec3{1, 1, 1};
    }

    std::uint32_t material_of(std::size_t texture) {
        const std::string& full = bsp_.textures[texture].name;
        const auto colour = texture_colour(texture);
        guessed_ += !colour;
        Material material = map_material(bsp_.textures[texture], textures_[texture].script, colour);
        const std::string base = plain_name(full.starts_with("textures/") ? full.substr(9) : full);
        material.name = base;
        for (std::size_t n = 2; !material_names_.insert(material.name).second; ++n) {
            const std::string ending = fmt::format("-{}", n);
            material.name = base.substr(0, 64 - ending.size()) + ending;
        }
        result_.materials.push_back(material);
        return static_cast<std::uint32_t>(result_.materials.size() - 1);
    }

    // Of the map, its entities, and the scripts of its textures.
    void add_left_out() {
        LeftOut left_out = bsp_.left_out;
        count_left_out(bsp_.entities, left_out);
        for (const Group& group : groups_)
            if (const ShaderScript* script = textures_[group.texture].script)
                for (const auto& [name, count] : script->left_out)
                    left_out.add("of shader scripts", name, count);
        for (std::string& line : left_out.lines()) result_.notes.push_back(std::move(line));
    }

    static void to_metres(Surface& surface) {
        for (Vec3& vertex : surface.vertices) vertex = vertex * metres_a_game_unit;
    }

    void add_surface_lights() {
        std::vector<Surface> lit;
        std::vector<std::size_t> lit_groups;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            if (textures_[groups_[g].texture].radiance <= 0 || groups_[g].surface.triangles.empty()) continue;
            drop_degenerate(groups_[g].surface);
            to_metres(groups_[g].surface);
            lit.push_back(std::exchange(groups_[g].surface, {}));
            lit_groups.push_back(g);
        }
        std::vector<std::vector<Surface>> parts = cluster_lights(lit, most_surface_lights);
        std::size_t lights = 0, triangles = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const std::size_t texture = groups_[lit_groups[i]].texture;
            const Vec3 radiance = light_colour(texture) * static_cast<float>(textures_[texture].radiance);
            const bool reflects = textures_[texture].surface == MapSurface::solid;
            const std::int32_t material = reflects ? static_cast<std::int32_t>(material_of(texture)) : -1;
            for (Surface& part : parts[i]) {
                ImportedLight& light = result_.lights.emplace_back();
                light.shape = ImportedLight::Shape::mesh;
                triangles += part.triangles.size();
                light.surface = std::move(part);
                light.radiance = radiance;
                light.material = material;
                ++lights;
            }
        }
        note("{} lights of {} triangles, from {} textures with q3map_surfacelight or a sky", lights,
             triangles, lit_groups.size());
    }

    void add_entity_lights() {
        std::size_t count = 0, dark = 0;
        for (const BspEntity& entity : bsp_.entities) {
            if (entity.value("classname") != "light") continue;
            if (++count > most_entity_lights)
                throw trace::DataError(fmt::format("{}: entities: found more than {} lights, expected fewer",
                                                   options_.map, most_entity_lights));
            const auto origin = triple_in(entity.value("origin"));
            if (!origin) {
                ++dark;
                continue;
            }
            float strength = 300;
            const std::string_view text = entity.value("light");
            std::from_chars(text.data(), text.data() + text.size(), strength);
            if (!(strength > 0 && strength <= 1e6f)) {
                ++dark;
                continue;
            }
            Vec3 colour = triple_in(entity.value("_color")).value_or(Vec3{1, 1, 1});
            for (int axis = 0; axis < 3; ++axis) colour[axis] = std::max(colour[axis], 0.0f);
            const float brightest = trace::max_component(colour);
            if (!(brightest > 0)) {
                ++dark;
                continue;
            }
            ImportedLight& light = result_.lights.emplace_back();
            light.shape = ImportedLight::Shape::sphere;
            light.center = *origin * metres_a_game_unit;
            light.radius = entity_light_radius;
            light.segments = 8;
            light.power =
                colour * static_cast<float>(watts_a_light_unit * double{strength} / double{brightest});
        }
        if (count > dark) note("{} light entities, as small spheres", count - dark);
        if (dark > 0) note("left out: {} light entities without an origin, a strength or a colour", dark);
    }

    void add_meshes() {
        std::map<MaterialKind, std::size_t> kinds;
        for (Group& group : groups_) {
            if (group.surface.triangles.empty()) continue;
            drop_degenerate(group.surface);
            if (group.surface.triangles.empty()) continue;
            to_metres(group.surface);
            const std::uint32_t material = material_of(group.texture);
            result_.meshes.push_back({material, std::move(group.surface)});
        }
        for (const Material& material : result_.materials) ++kinds[material.kind];
        note(
            "{} materials: {} diffuse, {} glossy, {} mirrors, {} dielectric; {} without an image, their "
            "colour by name",
            result_.materials.size(), kinds[MaterialKind::diffuse], kinds[MaterialKind::glossy],
            kinds[MaterialKind::mirror], kinds[MaterialKind::dielectric], guessed_);
    }

    void add_tour(std::string_view name) {
        const FreeSpace space(bsp_, triangles_);
        const std::vector<Stop> stops = stops_of(bsp_, space);
        if (stops.empty() || !stops.front().is_spawn)
            throw trace::DataError(
                fmt::format("{}: entities: found no spawn point outside walls, expected one", name));
        Tour tour =
            plan_tour(stops, space, texture_of_triangle_, most_tour_metres / double{metres_a_game_unit});
        for (Vec3* point : {&tour.camera.position, &tour.camera.target}) *point = *point * metres_a_game_unit;
        for (KeyFrame& key : tour.keys)
            for (Vec3* point : {&key.position, &key.target}) *point = *point * metres_a_game_unit;
        note("camera path of {} frames, {} keys: {}", tour.frames, tour.keys.size(),
             tour.walks ? "from spawn point to spawn point" : "at the first spawn point, no way leads on");
        result_.camera = tour.camera;
        result_.camera_path = std::move(tour.keys);
        result_.frames = tour.frames;
    }

    const Bsp& bsp_;
    const OpenArenaOptions& options_;
    Colours colours_;
    std::map<std::string, ShaderScript> scripts_;
    std::vector<Texture> textures_;
    std::vector<Group> groups_;
    std::vector<std::array<Vec3, 3>> triangles_;  // In game units, as the camera meets them.
    std::vector<std::uint32_t> texture_of_triangle_;
    std::set<std::string> material_names_;
    std::size_t guessed_ = 0;
    ImportedScene result_;
};

std::string one_line(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, std::min<std::size_t>(text.size(), 200)))
        if (c >= ' ' && c <= '~') result += c;
    return result;
}

// "Author: ..." of the map's text file, where an archive has one.
std::string author_of(const Pk3Archives& archives, const std::string& map) {
    const std::string entry = lower_case(map) + ".txt";
    if (!archives.has(entry)) return {};
    const auto bytes = archives.read(entry, most_script_bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = text.substr(at, end - at);
        at = end + 1;
        if (!line.starts_with("Author")) continue;
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos) continue;
        std::string author = one_line(line.substr(colon + 1));
        author.erase(0, std::min(author.find_first_not_of(' '), author.size()));
        return author;
    }
    return {};
}

}  // namespace

ImportedScene import_openarena(std::span<const std::filesystem::path> archives,
                               const OpenArenaOptions& options) {
    if (options.subdivision < 1 || options.subdivision > 32)
        throw trace::UsageError(fmt::format("subdivision: found {}, expected 1 to 32", options.subdivision));
    const Pk3Archives all(archives);
    const std::string entry = entry_of_map(all, options.map);
    const Bsp bsp = read_bsp(all.read(entry, most_map_bytes), all.place(entry));
    ImportedScene result = Importer(all, bsp, options).import(options.map);
    const std::string title = bsp.entities.empty() ? "" : one_line(bsp.entities.front().value("message"));
    const std::string author = author_of(all, options.map);
    result.origin = fmt::format("OpenArena map {}{}{} from {}", options.map,
                                title.empty() ? "" : fmt::format(" \"{}\"", title),
                                author.empty() ? "" : fmt::format(" by {}", author), all.archive(entry));
    result.licence =
        "GPL-2.0-or-later, as the data of OpenArena (Debian: /usr/share/doc/openarena-081-maps/copyright)";
    return result;
}

}  // namespace regather::imports
