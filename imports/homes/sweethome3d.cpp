#include "imports/homes/sweethome3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "imports/archive.h"
#include "imports/archived_model.h"
#include "imports/homes/home.h"
#include "imports/homes/wall.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::imports {

using trace::DataError;
using trace::in_quotes;
using trace::UsageError;

namespace {

constexpr double metres = 0.01;                                       // of a centimetre
constexpr double full_power = 120;                                    // [W] Of a light source at power 1.
constexpr double least_light_radius = 0.04, most_light_radius = 0.5;  // [m]
constexpr double margin = 2;   // [cm] That floors and ceilings of a storey reach beyond its walls.
constexpr double layer = 0.2;  // [cm] Between what lies on each other.
constexpr std::uint32_t least_frames = 30, least_frames_per_camera = 5;
constexpr double least_level = 0.07;   // Cosine of the pitch below which a view looks along the vertical.
constexpr double turn_radians = 0.35;  // To each side, at each camera of the path.
constexpr Rgb8 plaster{230, 230, 230}, ground{150, 140, 130};

std::string home_name(const std::string& entry) {
    const std::size_t slash = entry.rfind('/') + 1;
    return entry.substr(slash, entry.size() - slash - 4);
}

// Entries that are homes: Home.xml at the top, else XML whose root is <home> (its name stands in the first
// kilobyte).
std::vector<std::string> home_entries(const Zip& zip) {
    if (zip.has("Home.xml")) return {"Home.xml"};
    std::vector<std::string> entries;
    for (const std::string& name : zip.names()) {
        if (!name.ends_with(".xml")) continue;
        const std::vector<std::uint8_t> bytes = zip.read_start(name, 1024);
        const std::string_view start(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        if (start.find("<home") != std::string_view::npos) entries.push_back(name);
    }
    if (entries.empty())
        throw DataError(
            fmt::format("{}: found neither Home.xml nor another home in XML, expected one (homes saved by "
                        "Sweet Home 3D before 5.5 must be saved again)",
                        zip.archive()));
    return entries;
}

std::string chosen_entry(const Zip& zip, const std::string& home) {
    const std::vector<std::string> entries = home_entries(zip);
    std::vector<std::string> names;
    for (const std::string& entry : entries) {
        names.push_back(home_name(entry));
        if (names.back() == home) return entry;
    }
    const std::vector<std::string_view> words(names.begin(), names.end());
    if (!home.empty())
        throw UsageError(fmt::format("{}: found no home {}, expected {} (homes: {})", zip.archive(),
                                     in_quotes(home), trace::alternatives(trace::nearest_words(home, words)),
                                     trace::listed(words)));
    if (entries.size() > 1)
        throw UsageError(fmt::format("{}: found {} homes and no --home, expected one of {}", zip.archive(),
                                     names.size(), trace::listed(words)));
    return entries.front();
}

Vec3 unit_color(Rgb8 color) {
    const Vec3 light = linear(color);
    const float largest = max_component(light);
    return largest > 0 ? light * (1 / largest) : Vec3{1, 1, 1};
}

class HomeScene {
public:
    HomeScene(const Zip& zip, Home home) : zip_(zip), home_(std::move(home)), table_(scene_.materials) {
        for (const HomeLevel& level : home_.levels) levels_.emplace(level.id, &level);
        for (const HomePiece& piece : home_.pieces)
            if (piece.opening && piece.visible && is_shown(piece.level)) openings_.push_back(&piece);
    }
    HomeScene(const HomeScene&) = delete;
    HomeScene& operator=(const HomeScene&) = delete;

    ImportedScene build() {
        add_storeys();
        add_walls();
        add_rooms();
        for (std::size_t p = 0; p < home_.pieces.size(); ++p) add_piece(home_.pieces[p], p);
        add_cameras();
        scene_.notes = home_.left_out.lines();
        return std::move(scene_);
    }

private:
    [[noreturn]] void fail(const std::string& field, const std::string& found,
                           const std::string& expected) const {
        throw DataError(fmt::format("{}: {}: found {}, expected {}", zip_.archive(), field, found, expected));
    }

    void count_triangles(std::uint64_t more, const std::string& field) {
        triangles_ += more;
        if (triangles_ > most_home_triangles)
            fail(field, fmt::format("{} triangles so far", triangles_),
                 fmt::format("at most {}", most_home_triangles));
    }

    const HomeLevel* level_of(const std::string& id) const {
        const auto found = levels_.find(id);
        return found == levels_.end() ? nullptr : found->second;
    }
    double elevation_of(const std::string& level) const {
        const HomeLevel* found = level_of(level);
        return found ? found->elevation : 0;
    }
    double height_of(const std::string& level) const {
        const HomeLevel* found = level_of(level);
        return found && found->height > 0 ? found->height : home_.wall_height;
    }
    bool is_shown(const std::string& level) const {
        const HomeLevel* found = level_of(level);
        return !found || found->viewable;
    }

    void add_surface(const Material& material, Surface surface) {
        if (surface.triangles.empty()) return;
        scene_.meshes.push_back({table_.index_of(material), std::move(surface)});
    }

    static Surface slab(double x0, double y0, double x1, double y1, double z, bool up) {
        const std::array<PlanPoint, 4> corners{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
        return flat(corners, meshes::triangulate(corners), z, up);
    }

    static Surface flat(std::span<const PlanPoint> polygon,
                        std::span<const std::array<std::uint32_t, 3>> triangles, double z, bool up) {
        Surface surface;
        for (const PlanPoint p : polygon) surface.vertices.push_back(in_metres(p, z));
        surface.normals.resize(surface.vertices.size());
        // Turning y round turns the corners' sense: a positive area on the plan faces down.
        const bool turn = (twice_area(polygon) > 0) == up;
        for (const auto& [a, b, c] : triangles)
            surface.triangles.push_back(turn ? std::array{a, c, b} : std::array{a, b, c});
        return surface;
    }

    // A floor under each storey's walls and a ceiling on them: whatever gaps the rooms' own floors leave are
    // closed.
    void add_storeys() {
        struct Storey {
            double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9, top = 0;
        };
        std::map<std::string, Storey> storeys;
        for (const HomeWall& wall : home_.walls) {
            if (!is_shown(wall.level)) continue;
            Storey& storey = storeys[wall.level];
            const double reach =
                wall.thickness + margin +
                std::abs(wall.arc_extent) * std::hypot(wall.end.x - wall.start.x, wall.end.y - wall.start.y);
            for (const PlanPoint p : {wall.start, wall.end}) {
                storey.x0 = std::min(storey.x0, p.x - reach);
                storey.y0 = std::min(storey.y0, p.y - reach);
                storey.x1 = std::max(storey.x1, p.x + reach);
                storey.y1 = std::max(storey.y1, p.y + reach);
            }
            storey.top = std::max({storey.top, wall.height, wall.height_at_end});
        }
        for (const auto& [level, s] : storeys) {
            const double foot = elevation_of(level);
            add_surface(painted("ground", ground, 0), slab(s.x0, s.y0, s.x1, s.y1, foot + layer, true));
            add_surface(painted("plaster", plaster, 0),
                        slab(s.x0, s.y0, s.x1, s.y1, foot + s.top - layer, false));
        }
    }

    void add_walls() {
        const std::vector<WallOutline> outlines = wall_outlines(home_.walls);
        for (std::size_t w = 0; w < home_.walls.size(); ++w) {
            const HomeWall& wall = home_.walls[w];
            if (!is_shown(wall.level)) continue;
            const double foot = elevation_of(wall.level);
            std::vector<WallHole> holes;
            const PlanBox box = box_of(outlines[w]);
            for (const HomePiece* piece : openings_)
                if (may_cross(*piece, box)) holes.push_back(hole_of(*piece, foot));
            if (holes.size() > most_wall_openings)
                fail(fmt::format("wall[{}]", w), fmt::format("{} doors and windows", holes.size()),
                     fmt::format("at most {} in one wall", most_wall_openings));
            const WallSurfaces surfaces = extrude(wall, outlines[w], foot, holes);
            count_triangles(surfaces.left.triangles.size() + surfaces.right.triangles.size() +
                                surfaces.top.triangles.size(),
                            fmt::format("wall[{}]", w));
            add_surface(painted("wall", wall.left.value_or(plaster), wall.left_shininess), surfaces.left);
            add_surface(painted("wall", wall.right.value_or(plaster), wall.right_shininess), surfaces.right);
            add_surface(painted("wall", wall.top.value_or(plaster), 0), surfaces.top);
        }
    }

    struct PlanBox {
        double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
    };
    static PlanBox box_of(const WallOutline& outline) {
        PlanBox box;
        for (const std::vector<PlanPoint>* side : {&outline.left, &outline.right})
            for (const PlanPoint p : *side)
                box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x),
                       std::max(box.y1, p.y)};
        return box;
    }

    // Whether a circle round all that the piece cuts meets the box.
    static bool may_cross(const HomePiece& piece, const PlanBox& box) {
        const HomeOpening& o = *piece.opening;
        const double reach = piece.width * (0.5 + std::abs(o.wall_left) + o.wall_width) +
                             piece.depth * (0.5 + std::abs(o.wall_distance) + o.wall_thickness);
        return piece.x >= box.x0 - reach && piece.x <= box.x1 + reach && piece.y >= box.y0 - reach &&
               piece.y <= box.y1 + reach;
    }

    WallHole hole_of(const HomePiece& piece, double foot) const {
        const HomeOpening& o = *piece.opening;
        const double left = piece.width * (o.wall_left - 0.5), right = left + piece.width * o.wall_width;
        const double c = std::cos(piece.angle), s = std::sin(piece.angle);
        const double sense = piece.mirrored ? -1 : 1;
        const auto at = [&](double x, double y) {
            return PlanPoint{piece.x + c * sense * x - s * y, piece.y + s * sense * x + c * y};
        };
        const auto between = [&](double back, double front) {
            return std::array{at(left, back), at(right, back), at(right, front), at(left, front)};
        };
        const double back = piece.depth * (o.wall_distance - 0.5);
        const double low = elevation_of(piece.level) + piece.elevation - foot +
                           piece.height * (1 - o.wall_top - o.wall_height);
        WallHole hole{between(back, back + piece.depth * o.wall_thickness), low,
                      low + piece.height * o.wall_height};
        if (o.on_both_sides) hole.touch = between(piece.depth / -2, piece.depth / 2);
        return hole;
    }

    void add_rooms() {
        for (const HomeRoom& room : home_.rooms) {
            if (!is_shown(room.level)) continue;
            const auto triangles = meshes::triangulate(room.points);
            if (meshes::Triangulator().fill(room.points) != meshes::Triangulator::Result::whole)
                home_.left_out.add("of room", "parts of one that crosses itself");
            const double foot = elevation_of(room.level);
            if (room.floor_visible)
                add_surface(painted("floor", room.floor.value_or(ground), room.floor_shininess),
                            flat(room.points, triangles, foot + 2 * layer, true));
            if (room.ceiling_visible)
                add_surface(painted("ceiling", room.ceiling.value_or(plaster), room.ceiling_shininess),
                            flat(room.points, triangles, foot + height_of(room.level) - 2 * layer, false));
        }
    }

    const Model& model_of(const HomePiece& piece) {
        const auto found = models_.find(piece.model);
        if (found != models_.end()) return found->second;
        const Model& model = models_.emplace(piece.model, read_model(zip_, piece.model)).first->second;
        for (const std::string& note : model.notes) home_.left_out.add_note_of_model(note);
        return model;
    }

    void add_piece(const HomePiece& piece, std::size_t index) {
        if (!piece.visible || !is_shown(piece.level)) return;
        const Model& model = model_of(piece);
        count_triangles(model.triangles(), fmt::format("piece[{}] {}", index, in_quotes(piece.name)));
        const Placement placement = placement_of(piece);
        std::vector<Model::Part> parts = placed(model, placement);
        for (Model::Part& part : parts) paint(part.material, piece);
        add_parts(std::move(parts), table_, scene_);
        if (piece.power <= 0 || piece.light_sources.empty()) return;
        const Affine of_box = pose_of(model, placement).of_box;
        for (const HomeLightSource& source : piece.light_sources) add_light(piece, source, of_box);
    }

    Placement placement_of(const HomePiece& piece) const {
        Placement placement;
        placement.width = piece.width * metres;
        placement.depth = piece.depth * metres;
        placement.height = piece.height * metres;
        placement.angle = piece.angle;
        placement.pitch = piece.pitch;
        placement.roll = piece.roll;
        placement.mirrored = piece.mirrored;
        placement.model_rotation = piece.model_rotation;
        placement.centred = piece.model_centred;
        placement.foot = {piece.x * metres, -piece.y * metres,
                          (elevation_of(piece.level) + piece.elevation) * metres};
        return placement;
    }

    // The home's own colours on a material of a model.
    static void paint(Material& material, const HomePiece& piece) {
        if (material.kind == MaterialKind::dielectric || material.name == "mirror") return;
        std::optional<Rgb8> color = piece.color;
        std::optional<double> shininess = piece.shininess;
        for (const HomeMaterial& own : piece.materials)
            if (own.name == material.name) {
                if (own.color) color = own.color;
                if (own.shininess) shininess = own.shininess;
            }
        if (color) {
            const bool was_glossy = material.kind == MaterialKind::glossy;
            material = painted(material.name, *color, shininess.value_or(was_glossy ? 0.2 : 0));
        } else if (shininess && *shininess < 0.05 && material.kind == MaterialKind::glossy) {
            material = {.name = material.name, .diffuse = material.diffuse};
        }
    }

    // `of_box`: Pose::of_box of the piece. A source is measured from the left, the front and the foot.
    void add_light(const HomePiece& piece, const HomeLightSource& source, const Affine& of_box) {
        ImportedLight light;
        light.shape = ImportedLight::Shape::sphere;
        light.center = to_float(of_box({source.x - 0.5, source.z - 0.5, 0.5 - source.y}));
        light.radius = static_cast<float>(
            std::clamp(source.diameter * piece.width * metres / 2, least_light_radius, most_light_radius));
        light.power = unit_color(source.color) * static_cast<float>(full_power * piece.power);
        scene_.lights.push_back(light);
    }

    struct View {
        Vec3 position;
        double yaw = 0, pitch = 0;
    };

    static View view_of(const HomeCamera& camera) {
        return {in_metres({camera.x, camera.y}, camera.z), camera.yaw, camera.pitch};
    }

    // At yaw 0 it looks down the plan; a larger yaw looks farther clockwise. Pitch looks down.
    static Vec3 target_of(const View& view, double turn) {
        const double yaw = view.yaw + turn, pitch = view.pitch;
        return view.position + Vec3{static_cast<float>(-std::sin(yaw) * std::cos(pitch)),
                                    static_cast<float>(-std::cos(yaw) * std::cos(pitch)),
                                    static_cast<float>(-std::sin(pitch))};
    }

    // The vertical, but for a view that looks along it.
    static Vec3 up_of(const View& view, double turn) {
        const double yaw = view.yaw + turn, pitch = view.pitch;
        if (std::abs(std::cos(pitch)) > least_level) return {0, 0, 1};
        return {static_cast<float>(-std::sin(yaw) * std::sin(pitch)),
                static_cast<float>(-std::cos(yaw) * std::sin(pitch)), static_cast<float>(std::cos(pitch))};
    }

    void add_cameras() {
        std::vector<View> views;
        double field = 63 * std::numbers::pi / 180;
        for (const HomeCamera& camera : home_.cameras)
            if (camera.attribute == "observerCamera") {
                views.insert(views.begin(), view_of(camera));
                field = camera.field_of_view;
            }
        for (const HomeCamera& camera : home_.cameras)
            if (camera.attribute == "storedCamera" && !is_known(views, view_of(camera)))
                views.push_back(view_of(camera));
        for (const HomeRoom& room : home_.rooms)
            if (views.size() < 2 && is_shown(room.level)) views.push_back(in_room(room));
        if (views.empty()) fail("home", "neither a camera nor a room", "one of them to look from");
        scene_.camera.position = views[0].position;
        scene_.camera.target = target_of(views[0], 0);
        scene_.camera.up = up_of(views[0], 0);
        // The home's field of view is horizontal; pictures of it are 4 to 3.
        scene_.camera.vertical_fov_degrees =
            static_cast<float>(std::atan(std::tan(field / 2) * 3 / 4) * 360 / std::numbers::pi);
        add_path(views);
    }

    static bool is_known(const std::vector<View>& views, const View& view) {
        return std::any_of(views.begin(), views.end(), [&](const View& v) {
            return length(v.position - view.position) < 0.01f && std::abs(v.yaw - view.yaw) < 0.01;
        });
    }

    View in_room(const HomeRoom& room) const {
        PlanPoint middle;
        for (const PlanPoint p : room.points) middle = {middle.x + p.x, middle.y + p.y};
        const double n = static_cast<double>(room.points.size());
        return {in_metres({middle.x / n, middle.y / n}, elevation_of(room.level) + 0.64 * home_.wall_height),
                0, 0.1};
    }

    // From camera to camera, looking around at each. Between two there are walls, so the path jumps: every
    // frame is a key.
    void add_path(const std::vector<View>& views) {
        const auto count = static_cast<std::uint32_t>(views.size());
        const std::uint32_t each = std::max(least_frames_per_camera, (least_frames + count - 1) / count);
        for (const View& view : views)
            for (std::uint32_t i = 0; i < each; ++i) {
                const double turn = turn_radians * (2.0 * i / (each - 1) - 1);
                scene_.camera_path.push_back({static_cast<std::uint32_t>(scene_.camera_path.size()),
                                              view.position, target_of(view, turn), up_of(view, turn)});
            }
        scene_.frames = static_cast<std::uint32_t>(scene_.camera_path.size());
    }

    const Zip& zip_;
    Home home_;
    ImportedScene scene_;
    MaterialTable table_;
    std::map<std::string, Model> models_;
    std::map<std::string_view, const HomeLevel*> levels_;
    std::vector<const HomePiece*> openings_;
    std::uint64_t triangles_ = 0;
};

}  // namespace

ImportedScene import_sweethome3d(const std::filesystem::path& archive, const std::string& home) {
    const Zip zip = Zip::open(archive);
    const std::string entry = chosen_entry(zip, home);
    Home read = read_home(zip.read(entry, most_home_bytes), fmt::format("{}: {}", zip.archive(), entry));
    const std::string author = read.author, licence = read.licence, copyright = read.copyright;
    const std::string name = entry == "Home.xml" ? archive.stem().string() : home_name(entry);
    ImportedScene scene = HomeScene(zip, std::move(read)).build();
    scene.name = plain_name(name);
    scene.origin =
        fmt::format("{} of {}{}{}", home_name(entry), archive.filename().string(),
                    author.empty() ? "" : ", by " + author, copyright.empty() ? "" : "; " + copyright);
    scene.licence = licence.empty() ? "not stated in the file" : licence;
    return scene;
}

}  // namespace regather::imports
