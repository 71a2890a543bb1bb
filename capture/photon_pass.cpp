#include "capture/photon_pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>

#include "capture/light/surface.h"
#include "capture/sampler.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t most_specular_in_a_row = 10'000;
// Rounds of 32 blocks begin small and grow: where walls reflect nearly all, a few paths make all photons.
constexpr std::uint64_t first_block_paths = 16, most_block_paths = 2048, round_blocks = 32,
                        extra_paths = 100'000;

void add(Power& sum, Vec3 power) {
    for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += static_cast<double>(power[c]);
}

struct Flight {
    Vec3 position, direction, normal, power;  // power [W] times the number of paths
    PhotonOrigin origin;
};

/// Paths [first, first + count): what they stored and where their power went.
struct Block {
    std::vector<Flight> stored;
    std::vector<std::uint32_t> path_end;  // stored.size() after each path
    PhotonTally tally;
};

class Tracer {
public:
    Tracer(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
           const PhotonConfig& config)
        : scene_(scene),
          caster_(caster),
          lights_(lights),
          seed_(config.seed),
          kind_(config.kind),
          most_(config.photons) {}

    Block trace(std::uint64_t first, std::uint64_t count) const {
        Block block;
        for (std::uint64_t i = 0; i < count; ++i) {
            trace_path(first + i, block);
            block.path_end.push_back(static_cast<std::uint32_t>(block.stored.size()));
        }
        block.tally.paths = count;
        return block;
    }

private:
    void trace_path(std::uint64_t path, Block& block) const {
        PhotonTally& tally = block.tally;
        Sampler sampler(seed_, kind_ == PhotonKind::caustic ? Stream::caustic_photon : Stream::photon, path);
        const Emission from = lights_.emit(sampler);
        Vec3 origin = caster_.offset(from.position, from.normal), direction = from.direction,
             power = from.power;
        add(tally.emitted, power);

        bool caustic = false, only_specular = true;
        // Of a block that has more photons than asked for, no later one is used.
        for (std::uint32_t in_a_row = 0; in_a_row < most_specular_in_a_row && block.stored.size() <= most_;
             ++in_a_row) {
            const std::optional<Hit> hit = caster_.closest(origin, direction);
            if (!hit) return add(tally.escaped, power);
            const Vec3 incoming = -direction;
            const Surface at = surface_at(scene_, *hit, incoming);
            const Material& material = *at.material;
            if (is_specular(material)) caustic = only_specular;
            if (material.kind == MaterialKind::mirror) {
                add(tally.absorbed_by_specular, power * (Vec3{1, 1, 1} - material.specular));
                power = power * material.specular;
                if (power == Vec3{}) return;
                direction = reflected(at, incoming);
                origin = caster_.offset(hit->position, at.side);
            } else if (material.kind == MaterialKind::dielectric) {
                Vec3 onward;
                const bool through = sampler.uniform() >= fresnel(dot(incoming, at.normal), at.eta()) &&
                                     refracted(at, incoming, onward);
                direction = through ? onward : reflected(at, incoming);
                origin = caster_.offset(hit->position, through ? -at.side : at.side);
            } else {
                const bool stored = kind_ == PhotonKind::all || caustic == (kind_ == PhotonKind::caustic);
                if (!stored) {
                    add(tally.not_stored, power);
                } else if (!trace::is_finite(power) || !trace::is_finite(hit->position)) {
                    tally.nonfinite.count(Stage::photon);
                    return;
                } else {
                    const PhotonOrigin met = !only_specular ? PhotonOrigin::surface
                                             : caustic      ? PhotonOrigin::specular
                                                            : PhotonOrigin::light;
                    block.stored.push_back({hit->position, direction, at.side, power, met});
                    add(tally.stored, power);
                }
                if (kind_ == PhotonKind::caustic) return;
                caustic = only_specular = false;
                in_a_row = 0;
                const Scatter next = scatter(material, at.normal, incoming, sampler);
                if (next.absorbed || dot(next.direction, at.side) <= 0) return;
                power = power * next.weight;
                add(tally.reflected, power);
                direction = next.direction;
                origin = caster_.offset(hit->position, at.side);
            }
        }
        add(tally.cut_off, power);
    }

    const Scene& scene_;
    const RayCaster& caster_;
    const LightSampler& lights_;
    std::uint64_t seed_;
    PhotonKind kind_;
    std::size_t most_;
};

void add(PhotonTally& sum, const PhotonTally& part) {
    for (std::size_t c = 0; c < 3; ++c) {
        sum.emitted[c] += part.emitted[c];
        sum.reflected[c] += part.reflected[c];
        sum.stored[c] += part.stored[c];
        sum.escaped[c] += part.escaped[c];
        sum.absorbed_by_specular[c] += part.absorbed_by_specular[c];
        sum.not_stored[c] += part.not_stored[c];
        sum.cut_off[c] += part.cut_off[c];
    }
    sum.paths += part.paths;
    sum.nonfinite += part.nonfinite;
}

void scale(Power& power, double factor) {
    for (double& channel : power) channel *= factor;
}

}  // namespace

PhotonPass trace_photons(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                         const PhotonConfig& config) {
    PhotonPass pass;
    if (lights.dark() || config.photons == 0) return pass;
    const Tracer tracer(scene, caster, lights, config);

    std::vector<Flight> stored;
    if (config.kind != PhotonKind::caustic) stored.reserve(config.photons);
    const std::uint64_t most_paths = std::uint64_t{config.paths_per_photon} * config.photons + extra_paths;
    std::vector<Block> blocks(round_blocks);
    std::uint64_t block_paths = first_block_paths;
    for (std::uint64_t first = 0; stored.size() < config.photons && first < most_paths;
         first += round_blocks * block_paths, block_paths = std::min(4 * block_paths, most_block_paths)) {
        tbb::parallel_for(std::uint64_t{0}, round_blocks, [&](std::uint64_t b) {
            blocks[b] = tracer.trace(first + b * block_paths, block_paths);
        });
        for (std::uint64_t b = 0; b < round_blocks && stored.size() < config.photons; ++b) {
            Block& block = blocks[b];
            const std::size_t room = config.photons - stored.size();
            if (block.stored.size() > room) {
                const auto last = std::lower_bound(block.path_end.begin(), block.path_end.end(), room);
                block = tracer.trace(first + b * block_paths,
                                     static_cast<std::uint64_t>(last - block.path_end.begin()) + 1);
                for (const Flight& flight : std::span(block.stored).subspan(room)) {
                    add(block.tally.cut_off, flight.power);
                    add(block.tally.stored, -flight.power);
                }
                block.stored.resize(room);
            }
            stored.insert(stored.end(), block.stored.begin(), block.stored.end());
            add(pass.tally, block.tally);
        }
    }

    const double share = 1 / static_cast<double>(pass.tally.paths);
    for (Power* power : {&pass.tally.emitted, &pass.tally.reflected, &pass.tally.stored, &pass.tally.escaped,
                         &pass.tally.absorbed_by_specular, &pass.tally.not_stored, &pass.tally.cut_off})
        scale(*power, share);
    pass.photons.resize(stored.size());
    pass.origin.resize(stored.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, stored.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            trace::Photon& photon = pass.photons[i];
            photon.position = stored[i].position;
            pass.origin[i] = stored[i].origin;
            trace::encode_power(stored[i].power * static_cast<float>(share), photon.power);
            trace::encode_direction(stored[i].direction, photon);
            trace::encode_normal(stored[i].normal, photon);
        }
    });
    return pass;
}

}  // namespace regather::capture
