#include "scenes/needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scenes/keys.h"
#include "trace/error.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::scenes {

namespace {

struct Use {
    std::uint64_t triangles = 0;
    std::vector<std::string_view> materials;  // In the order of Scene::materials.
};

template <class Wanted>
Use use_of(const Scene& scene, const std::vector<std::uint64_t>& triangles_of_material, Wanted wanted) {
    Use use;
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (wanted(scene.materials[m]) && triangles_of_material[m] > 0) {
            use.triangles += triangles_of_material[m];
            use.materials.push_back(scene.materials[m].name);
        }
    return use;
}

std::string describe(const Use& use, std::string_view kinds) {
    return fmt::format("{} of {} ({}).",
                       use.triangles == 1 ? "1 triangle is" : fmt::format("{} triangles are", use.triangles),
                       kinds, trace::listed(use.materials));
}

bool is_lit_from_an_area(const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const AreaLight& light) { return light.area() > 0; });
}

}  // namespace

Needs needs_of(const Scene& scene) {
    std::vector<std::uint64_t> triangles_of_material(scene.materials.size());
    for (const std::uint32_t material : scene.triangle_material) ++triangles_of_material[material];
    const Use specular = use_of(scene, triangles_of_material, [](const Material& m) {
        return m.kind == MaterialKind::mirror || m.kind == MaterialKind::dielectric;
    });
    const Use glossy = use_of(scene, triangles_of_material, [](const Material& m) {
        return m.kind == MaterialKind::glossy && max_component(m.specular) > 0;
    });

    Needs needs;
    const bool lit = is_lit_from_an_area(scene);
    needs.shadow_rays = {
        "shadow_rays", lit,
        lit ? fmt::format(
                  "{} of area {} the scene.",
                  scene.lights.size() == 1 ? "1 light" : fmt::format("{} lights", scene.lights.size()),
                  scene.lights.size() == 1 ? "lights" : "light")
            : "The scene has no light of area."};
    const bool mirrors = specular.triangles > 0;
    needs.specular_rays = {"specular_rays", mirrors,
                           mirrors ? describe(specular, "mirror or dielectric materials")
                                   : "No triangle is a mirror or a dielectric."};
    needs.caustics = {"caustics", lit && mirrors,
                      lit && mirrors
                          ? "Light of the area lights may reach other surfaces by way of specular ones."
                      : mirrors ? "The scene has no light of area whose light could be gathered."
                                : "No triangle is a mirror or a dielectric: no path makes a caustic."};
    const bool gloss = glossy.triangles > 0;
    needs.glossy_lobes = {"glossy_lobes", gloss,
                          gloss ? describe(glossy, "glossy materials") : "No triangle is glossy.", false};
    const bool moves = !scene.camera_path.empty();
    needs.camera_path = {
        "camera_path", moves,
        moves ? fmt::format("The camera moves through {} frames.", scene.frames) : "The camera stands still.",
        false};
    return needs;
}

void Needs::keep(const std::set<std::string>& parts) {
    std::array<Need*, 5> all{&shadow_rays, &specular_rays, &caustics, &glossy_lobes, &camera_path};
    for (const std::string& part : parts) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const Need* need) {
            return need->can_be_kept && need->part == part;
        });
        if (found == all.end()) {
            std::vector<std::string_view> names;
            for (const Need* need : all)
                if (need->can_be_kept) names.push_back(need->part);
            throw trace::UsageError(fmt::format("keep: found the unknown part '{}', expected {}",
                                                trace::shown(part), trace::listed(names)));
        }
        if ((*found)->needed) continue;
        (*found)->reason = "Kept although it is not needed: " + (*found)->reason;
        (*found)->needed = true;
    }
}

}  // namespace regather::scenes
