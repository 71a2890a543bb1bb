#include "study/room.h"

#include <fmt/format.h>

namespace regather::study {

trace::Vec3 Room::point(Vec3d p) const {
    return to_float(placement_.scale * p + placement_.shift);
}

trace::Vec3 Room::edge(Vec3d e) const {
    return to_float(placement_.scale * e);
}

std::uint32_t Room::add(const scenes::Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::uint32_t Room::diffuse(double albedo) {
    const auto a = static_cast<float>(albedo);
    scenes::Material material;
    material.name = fmt::format("diffuse {}", albedo);
    material.diffuse = {a, a, a};
    return add(material);
}

void Room::triangle(Vec3d a, Vec3d b, Vec3d c, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const Vec3d corner : {a, b, c}) scene.vertices.push_back(point(corner));
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangle_material.push_back(material);
    scene.triangle_light.push_back(-1);
}

void Room::quad(Vec3d corner, Vec3d u, Vec3d v, std::uint32_t material) {
    const Vec3d far = corner + u + v;
    triangle(corner, corner + u, far, material);
    triangle(corner, far, corner + v, material);
}

void Room::light(Vec3d corner, Vec3d u, Vec3d v, double radiance, std::uint32_t material) {
    quad(corner, u, v, material);
    const std::size_t count = scene.triangle_light.size();
    for (std::size_t t = count - 2; t < count; ++t)
        scene.triangle_light[t] = static_cast<std::int32_t>(scene.lights.size());
    const auto r = static_cast<float>(radiance);
    scenes::AreaLight light;
    light.corner = point(corner);
    light.edge_u = edge(u);
    light.edge_v = edge(v);
    light.radiance = {r, r, r};
    scene.lights.push_back(light);
}

void Room::box(Vec3d low, Vec3d high, std::uint32_t material, bool inwards) {
    const Vec3d x{high.x - low.x, 0, 0}, y{0, high.y - low.y, 0}, z{0, 0, high.z - low.z};
    const auto face = [&](Vec3d corner, Vec3d u, Vec3d v) {
        inwards ? quad(corner, u, v, material) : quad(corner, v, u, material);
    };
    face(low, x, y);
    face({low.x, low.y, high.z}, y, x);
    face(low, z, x);
    face({low.x, high.y, low.z}, x, z);
    face(low, y, z);
    face({high.x, low.y, low.z}, z, y);
}

void Room::walls(Vec3d low, Vec3d high, std::uint32_t material) {
    box(low, high, material, true);
}

void Room::block(Vec3d low, Vec3d high, std::uint32_t material) {
    box(low, high, material, false);
}

void Room::look(Vec3d from, Vec3d at, double fov_degrees) {
    scene.camera.position = point(from);
    scene.camera.target = point(at);
    scene.camera.vertical_fov_degrees = static_cast<float>(fov_degrees);
}

Room furnished_room(const Placement& placement, double light_gap) {
    Room room(placement);
    room.scene.name = "furnished";
    const std::uint32_t wall = room.diffuse(0.6), block = room.diffuse(0.3), black = room.diffuse(0);
    scenes::Material mirror;
    mirror.kind = scenes::MaterialKind::mirror;
    mirror.specular = {0.9f, 0.9f, 0.9f};
    room.walls({0, 0, 0}, {1, 1, 1}, wall);
    room.block({0.55, 0.5, 0.002}, {0.8, 0.8, 0.4}, block);
    room.quad({0.05, 0.98, 0.2}, {0.3, 0, 0}, {0, 0, 0.5}, room.add(mirror));
    room.light({0.35, 0.35, 1 - light_gap}, {0, 0.3, 0}, {0.3, 0, 0}, 10, black);
    room.look({0.45, 0.06, 0.5}, {0.5, 1, 0.42}, 65);
    return room;
}

Room furnace(double albedo) {
    Room room;
    room.scene.name = "furnace";
    const std::uint32_t wall = room.diffuse(albedo);
    const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    room.light({0, 0, 0}, x, y, 1, wall);
    room.light({0, 0, 1}, y, x, 1, wall);
    room.light({0, 0, 0}, z, x, 1, wall);
    room.light({0, 1, 0}, x, z, 1, wall);
    room.light({0, 0, 0}, y, z, 1, wall);
    room.light({1, 0, 0}, z, y, 1, wall);
    room.look({0.4, 0.5, 0.5}, {1, 0.52, 0.48}, 5);
    return room;
}

}  // namespace regather::study
