#include "study/room.h"

#include <fmt/format.h>

namespace regather::study {
namespace {

Double3 sum(const Double3& a, const Double3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

}  // namespace

trace::Vec3 Room::point(const Double3& p) const {
    return {static_cast<float>(placement_.scale * p[0] + placement_.shift[0]),
            static_cast<float>(placement_.scale * p[1] + placement_.shift[1]),
            static_cast<float>(placement_.scale * p[2] + placement_.shift[2])};
}

trace::Vec3 Room::edge(const Double3& e) const {
    return {static_cast<float>(placement_.scale * e[0]), static_cast<float>(placement_.scale * e[1]),
            static_cast<float>(placement_.scale * e[2])};
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

void Room::triangle(const Double3& a, const Double3& b, const Double3& c, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const Double3& corner : {a, b, c}) scene.vertices.push_back(point(corner));
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangle_material.push_back(material);
    scene.triangle_light.push_back(-1);
}

void Room::quad(const Double3& corner, const Double3& u, const Double3& v, std::uint32_t material) {
    const Double3 far = sum(sum(corner, u), v);
    triangle(corner, sum(corner, u), far, material);
    triangle(corner, far, sum(corner, v), material);
}

void Room::light(const Double3& corner, const Double3& u, const Double3& v, double radiance,
                 std::uint32_t material) {
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

void Room::box(const Double3& low, const Double3& high, std::uint32_t material, bool inwards) {
    const Double3 x{high[0] - low[0], 0, 0}, y{0, high[1] - low[1], 0}, z{0, 0, high[2] - low[2]};
    const auto face = [&](const Double3& corner, const Double3& u, const Double3& v) {
        inwards ? quad(corner, u, v, material) : quad(corner, v, u, material);
    };
    face(low, x, y);
    face({low[0], low[1], high[2]}, y, x);
    face(low, z, x);
    face({low[0], high[1], low[2]}, x, z);
    face(low, y, z);
    face({high[0], low[1], low[2]}, z, y);
}

void Room::walls(const Double3& low, const Double3& high, std::uint32_t material) {
    box(low, high, material, true);
}

void Room::block(const Double3& low, const Double3& high, std::uint32_t material) {
    box(low, high, material, false);
}

void Room::look(const Double3& from, const Double3& at, double fov_degrees) {
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
    const Double3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
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
