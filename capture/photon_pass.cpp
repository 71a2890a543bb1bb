#include "capture/photon_pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>

#include "capture/bsdf.h"
#include "capture/sampler.h"
#include "capture/surface.h"

namespace regather::capture {
namespace {

constexpr std::uint32_t max_bounces = 10'000;
constexpr std::uint64_t block_paths = 2048, round_blocks = 32, paths_per_photon = 100;

void add(Power& sum, Vec3 power) {
    for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += static_cast<double>(power[c]);
}

struct Flight {
    Vec3 position, direction, power;  // power [W] times the number of paths
};

/// Paths [first, first + count): what they stored and where their power went.
struct Block {
    std::vector<Flight> stored;
    std::vector<std::uint32_t> path_end;  // stored.size() after each path
    PhotonTally tally;
};

class Tracer {
public:
    Tracer(const Scene& scene, const RayCaster& caster, std::uint64_t seed)
        : scene_(scene), caster_(caster), seed_(seed) {
        for (const scenes::AreaLight& light : scene.lights) {
            const Vec3 power = light.power();
            total_ += static_cast<double>(power.x) + power.y + power.z;
            cumulative_.push_back(total_);
        }
    }
    bool dark() const { return !(total_ > 0); }

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
        Sampler sampler(seed_, Stream::photon, path);
        const double pick = static_cast<double>(sampler.uniform()) * total_;
        const auto after = std::upper_bound(cumulative_.begin(), cumulative_.end(), pick);
        const auto chosen = std::min(static_cast<std::size_t>(after - cumulative_.begin()), cumulative_.size() - 1);
        const scenes::AreaLight& light = scene_.lights[chosen];
        const double share = (cumulative_[chosen] - (chosen == 0 ? 0 : cumulative_[chosen - 1])) / total_;

        const float u = sampler.uniform(), v = sampler.uniform(), s = sampler.uniform(), t = sampler.uniform();
        Vec3 origin = caster_.offset(light.corner + light.edge_u * u + light.edge_v * v, light.normal());
        Vec3 direction = Frame(light.normal()).to_world(cosine_hemisphere(s, t));
        Vec3 power = light.power() * static_cast<float>(1 / share);
        add(tally.emitted, power);

        for (std::uint32_t bounce = 0; bounce < max_bounces; ++bounce) {
            const std::optional<Hit> hit = caster_.closest(origin, direction);
            if (!hit) return add(tally.escaped, power);
            const Vec3 incoming = -direction;
            const Surface at = surface_at(scene_, *hit, incoming);
            const Material& material = *at.material;
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
                block.stored.push_back({hit->position, direction, power});
                add(tally.stored, power);
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
    std::uint64_t seed_;
    double total_ = 0;
    std::vector<double> cumulative_;
};

void add(PhotonTally& sum, const PhotonTally& part) {
    for (std::size_t c = 0; c < 3; ++c) {
        sum.emitted[c] += part.emitted[c];
        sum.reflected[c] += part.reflected[c];
        sum.stored[c] += part.stored[c];
        sum.escaped[c] += part.escaped[c];
        sum.absorbed_by_specular[c] += part.absorbed_by_specular[c];
        sum.cut_off[c] += part.cut_off[c];
    }
    sum.paths += part.paths;
}

void scale(Power& power, double factor) {
    for (double& channel : power) channel *= factor;
}

}  // namespace

PhotonPass trace_photons(const Scene& scene, const RayCaster& caster, const PhotonConfig& config) {
    PhotonPass pass;
    const Tracer tracer(scene, caster, config.seed);
    if (tracer.dark() || config.photons == 0) return pass;

    std::vector<Flight> stored;
    stored.reserve(config.photons);
    const std::uint64_t most_paths = paths_per_photon * config.photons + 1'000'000;
    std::vector<Block> blocks(round_blocks);
    for (std::uint64_t first = 0; stored.size() < config.photons && first < most_paths;
         first += round_blocks * block_paths) {
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
                         &pass.tally.absorbed_by_specular, &pass.tally.cut_off})
        scale(*power, share);
    pass.photons.resize(stored.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, stored.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            trace::Photon& photon = pass.photons[i];
            photon.position = stored[i].position;
            trace::encode_power(stored[i].power * static_cast<float>(share), photon.power);
            trace::encode_direction(stored[i].direction, photon);
        }
    });
    return pass;
}

}  // namespace regather::capture
