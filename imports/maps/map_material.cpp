#include "imports/maps/map_material.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "imports/maps/pk3.h"

namespace regather::imports {

namespace {

struct Tone {
    std::string_view word;
    Vec3 albedo;
};
// Of textures whose image is not at hand. The first word that is in the name decides.
constexpr std::array palette{Tone{"brick", {0.35f, 0.20f, 0.14f}}, Tone{"wood", {0.36f, 0.22f, 0.11f}},
                             Tone{"panel", {0.36f, 0.24f, 0.14f}}, Tone{"gold", {0.60f, 0.45f, 0.15f}},
                             Tone{"rust", {0.34f, 0.18f, 0.10f}},  Tone{"brn", {0.33f, 0.23f, 0.15f}},
                             Tone{"blue", {0.18f, 0.24f, 0.45f}},  Tone{"red", {0.48f, 0.13f, 0.11f}},
                             Tone{"green", {0.16f, 0.36f, 0.15f}}, Tone{"grass", {0.16f, 0.30f, 0.10f}},
                             Tone{"leaf", {0.16f, 0.30f, 0.10f}},  Tone{"mud", {0.27f, 0.20f, 0.13f}},
                             Tone{"dirt", {0.30f, 0.23f, 0.16f}},  Tone{"sand", {0.50f, 0.43f, 0.30f}},
                             Tone{"snow", {0.75f, 0.78f, 0.80f}},  Tone{"rock", {0.34f, 0.31f, 0.28f}},
                             Tone{"stn", {0.42f, 0.39f, 0.35f}},   Tone{"stone", {0.42f, 0.39f, 0.35f}},
                             Tone{"block", {0.42f, 0.39f, 0.35f}}, Tone{"concret", {0.45f, 0.44f, 0.42f}},
                             Tone{"tile", {0.45f, 0.43f, 0.40f}},  Tone{"roof", {0.30f, 0.20f, 0.17f}},
                             Tone{"floor", {0.38f, 0.35f, 0.31f}}, Tone{"wall", {0.48f, 0.45f, 0.40f}},
                             Tone{"metal", {0.40f, 0.40f, 0.42f}}, Tone{"mtl", {0.40f, 0.40f, 0.42f}},
                             Tone{"steel", {0.45f, 0.46f, 0.48f}}, Tone{"lava", {0.55f, 0.20f, 0.05f}},
                             Tone{"trim", {0.40f, 0.37f, 0.33f}},  Tone{"light", {0.60f, 0.60f, 0.58f}}};
constexpr Vec3 plain_tone{0.42f, 0.40f, 0.37f};

// Game textures are darker than what they show, shadows are painted on them: as they are, light would die
// away at once.
constexpr float brighter = 2;
constexpr float darkest = 0.02f, brightest = 0.8f;

template <std::size_t Count>
bool has_word(std::string_view name, const std::array<std::string_view, Count>& words) {
    return std::any_of(words.begin(), words.end(),
                       [&](auto word) { return name.find(word) != std::string_view::npos; });
}

constexpr std::array<std::string_view, 3> mirror_words{"mirror", "chrome", "window"};
constexpr std::array<std::string_view, 2> glass_words{"glass", "crystal"};
constexpr std::array<std::string_view, 9> metal_words{"metal", "mtl",  "steel", "pewter", "iron",
                                                      "shiny", "tech", "grate", "rust"};
constexpr std::array<std::string_view, 3> polished_words{"marble", "polish", "gold"};
constexpr std::array<std::string_view, 10> effect_words{"flame", "fire",  "smoke", "beam",   "flare",
                                                        "decal", "blood", "fog",   "corona", "_shadow"};

Vec3 clamped(Vec3 colour) {
    for (int axis = 0; axis < 3; ++axis) colour[axis] = std::clamp(colour[axis], darkest, brightest);
    return colour;
}

Vec3 albedo_of(std::string_view name, const std::optional<Vec3>& texture_colour) {
    if (texture_colour) return clamped(*texture_colour * brighter);
    for (const Tone& tone : palette)
        if (name.find(tone.word) != std::string_view::npos) return tone.albedo;
    return plain_tone;
}

// "light5_15k" gives 15000.
double thousands_in(std::string_view name) {
    if (name.empty() || name.back() != 'k') return 0;
    const std::size_t underscore = name.rfind('_');
    if (underscore == std::string_view::npos) return 0;
    const std::string_view digits = name.substr(underscore + 1, name.size() - underscore - 2);
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc{} && end == digits.data() + digits.size() && value <= 1000 ? 1000.0 * value : 0;
}

}  // namespace

MapSurface map_surface(const BspTexture& texture, const ShaderScript* script) {
    const std::string name = lower_case(texture.name);
    const auto parm = [&](std::string_view word) { return script != nullptr && script->has_parm(word); };
    if ((texture.surface_flags & BspTexture::sky) != 0 || parm("sky")) return MapSurface::sky;
    if ((texture.surface_flags & (BspTexture::nodraw | BspTexture::skip | BspTexture::hint)) != 0 ||
        parm("nodraw") || name.starts_with("textures/common/") || name == "noshader" ||
        name.starts_with("flareshader"))
        return MapSurface::open;
    if ((texture.contents & BspTexture::fog) != 0 || parm("fog")) return MapSurface::open;
    const bool liquid =
        (texture.contents & (BspTexture::water | BspTexture::slime | BspTexture::lava)) != 0 ||
        parm("water") || parm("slime") || parm("lava");
    if (liquid || has_word(name, glass_words)) return MapSurface::solid;
    if (has_word(name, effect_words)) return MapSurface::open;
    const bool in_the_way = (texture.contents & BspTexture::solid) != 0;
    if (!in_the_way) return MapSurface::open;  // Fences, leaves, beams: one flies through them in the game.
    const bool unlit = (texture.surface_flags & BspTexture::nolightmap) != 0;
    if (script != nullptr && script->see_through && unlit) return MapSurface::open;
    return MapSurface::solid;
}

Material map_material(const BspTexture& texture, const ShaderScript* script,
                      const std::optional<Vec3>& texture_colour) {
    const std::string name = lower_case(texture.name);
    const auto parm = [&](std::string_view word) { return script != nullptr && script->has_parm(word); };
    const bool see_through =
        (texture.contents & BspTexture::solid) == 0 || (script != nullptr && script->see_through);
    const Vec3 albedo = albedo_of(name, texture_colour);
    Material material;
    material.diffuse = albedo;
    if ((texture.contents & BspTexture::water) != 0 || parm("water") ||
        (name.find("water") != std::string::npos && see_through)) {
        material.kind = MaterialKind::dielectric;
        material.index_of_refraction = 1.33f;
    } else if (has_word(name, glass_words) && see_through) {
        material.kind = MaterialKind::dielectric;
        material.index_of_refraction = 1.5f;
    } else if ((script != nullptr && script->portal) || has_word(name, mirror_words)) {
        material.kind = MaterialKind::mirror;
        // A dark pane or polished metal: some of the light, tinted a little by the texture.
        material.specular = clamped(albedo * 0.5f + Vec3{0.3f, 0.3f, 0.3f});
    } else if (has_word(name, metal_words) || has_word(name, polished_words) || has_word(name, glass_words) ||
               (texture.contents & BspTexture::slime) != 0 || (script != nullptr && script->environment)) {
        material.kind = MaterialKind::glossy;
        const bool metal = has_word(name, metal_words);
        material.diffuse = albedo * (metal ? 0.5f : 0.8f);
        material.specular = metal ? albedo * 0.4f + Vec3{0.1f, 0.1f, 0.1f} : Vec3{0.1f, 0.1f, 0.1f};
        material.exponent = name.find("rust") != std::string::npos ? 10.0f : metal ? 60.0f : 200.0f;
    }
    return material;
}

double map_radiance(const BspTexture& texture, const ShaderScript* script) {
    const bool is_sky = map_surface(texture, script) == MapSurface::sky;
    const double value = script != nullptr
                             ? script->surface_light
                             : std::max(is_sky ? 100.0 : 0.0, thousands_in(lower_case(texture.name)));
    const double sun = script != nullptr && is_sky ? 0.5 * script->sun_intensity : 0.0;
    return (value * 0.25 * 3 + sun) / light_map_white;
}

}  // namespace regather::imports
