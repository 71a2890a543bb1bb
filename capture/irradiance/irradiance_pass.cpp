#include "capture/irradiance/irradiance_pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace regather::capture {
namespace {

constexpr std::uint64_t seen_pixels = 4096, hemisphere_points = 32;  // one thread's at a time
constexpr std::size_t hemisphere_rays = 1 << 19;                     // held at once
constexpr std::uint32_t tile = 16;                                   // of what is told of neighbouring pixels
constexpr float least_footprint_cosine = 0.1f;

}  // namespace

IrradiancePass::IrradiancePass(const Scene& scene, const RayCaster& caster, const LightSampler& lights,
                               const QueryConfig& config, PassParts parts)
    : scene_(scene),
      caster_(caster),
      lights_(lights),
      config_(config),
      parts_(parts),
      spec_(parse_irradiance_cache(config.irradiance_cache)),
      grid_(HemisphereGrid::of(spec_.rays() > 0 ? spec_.rays() : config.gather_rays)) {
    find_points();
    const trace::Bounds3 box = scene.bounds();
    const double far = trace::length(Vec3d(box.max) - Vec3d(box.min));
    seeding_ = std::make_unique<IrradianceSeeding>(points_, spec_, grid_, box, far > 0 ? far : 1);
}

void IrradiancePass::find_points() {
    const std::uint64_t pixels = std::uint64_t{config_.width} * config_.height;
    std::vector<std::vector<PixelPaths::DiffusePoint>> parts((pixels + seen_pixels - 1) / seen_pixels);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        PixelWork scratch;
        PassParts nothing_kept = parts_;
        nothing_kept.rays = false;
        PixelPaths paths(scene_, caster_, lights_, config_, nothing_kept, scratch);
        const std::uint64_t end = std::min(pixels, (part + 1) * seen_pixels);
        for (std::uint64_t pixel = part * seen_pixels; pixel < end; ++pixel)
            paths.look(static_cast<std::uint32_t>(pixel), parts[part]);
    });
    // The side of the square that a pixel sees of a surface at unit distance, head on.
    const float unit = 2 * std::tan(scene_.camera.vertical_fov_degrees * (std::numbers::pi_v<float> / 360)) /
                       static_cast<float>(config_.height);
    for (const std::vector<PixelPaths::DiffusePoint>& part : parts)
        for (const PixelPaths::DiffusePoint& point : part) {
            found_.push_back(point);
            // Straight from the camera, also behind mirrors: a path's own footprint knows no bound there.
            const float distance = trace::length(point.at.position - scene_.camera.position);
            const float cosine = std::max(dot(point.at.normal, point.at.to_viewer), least_footprint_cosine);
            points_.push_back({{point.at.position, point.at.normal},
                               point.pixel % config_.width,
                               point.pixel / config_.width,
                               static_cast<double>(distance * unit / std::sqrt(cosine))});
        }
}

bool IrradiancePass::next(PixelWork& work) {
    work.clear();
    while (begun_ == wanted_.size()) {
        begun_ = 0;
        if (!seeding_->next(wanted_)) return false;
    }
    const std::size_t count =
        std::min(std::max<std::size_t>(hemisphere_rays / grid_.cells(), 1), wanted_.size() - begun_);
    const std::size_t cells = grid_.cells();
    incoming_.assign(count * cells, {});
    query_.assign(count * cells, PixelPaths::no_query);
    std::vector<PixelWork> parts((count + hemisphere_points - 1) / hemisphere_points);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        PixelPaths paths(scene_, caster_, lights_, config_, parts_, parts[part]);
        const std::size_t end = std::min<std::size_t>(count, (part + 1) * hemisphere_points);
        for (std::size_t i = part * hemisphere_points; i < end; ++i)
            paths.gather_hemisphere(found_[wanted_[begun_ + i]], grid_,
                                    std::span(incoming_).subspan(i * cells, cells),
                                    std::span(query_).subspan(i * cells, cells));
    });
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const auto before = static_cast<std::uint32_t>(work.queries.size());
        const std::size_t end = std::min<std::size_t>(count, (part + 1) * hemisphere_points);
        for (std::size_t i = part * hemisphere_points * cells; i < end * cells; ++i)
            if (query_[i] != PixelPaths::no_query) query_[i] += before;
        work.append(parts[part]);
    }
    factor_ = work.queries.weight;
    for (std::size_t i = 0; i < query_.size(); ++i) {
        if (query_[i] == PixelPaths::no_query) continue;
        const PixelPaths::Shaded& at = found_[wanted_[begun_ + i / cells]].at;
        Vec3& weight = work.queries.weight[query_[i]];
        weight = weight * at.throughput * at.material->diffuse * (1 / static_cast<float>(cells));
    }
    begun_ += count;
    return true;
}

void IrradiancePass::add(std::span<const Vec3> radiance, Nonfinite& nonfinite) {
    for (std::size_t i = 0; i < query_.size(); ++i)
        if (const std::uint32_t q = query_[i]; q != PixelPaths::no_query)
            incoming_[i].radiance += nonfinite.checked(Stage::gather, factor_[q] * radiance[q]);
    seeding_->add(incoming_);
}

WaitingPixels IrradiancePass::waiting() const {
    return waiting_pixels(points_, octree(), scene_.bounds(), {spec_.latency(), spec_.entries(), tile});
}

double IrradiancePass::scatter() const {
    std::vector<std::uint8_t> gathers(points_.size());
    tbb::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t i) {
        gathers[i] = 1;
        octree().search(points_[i].point, octree().tolerance(), [&](std::uint32_t) { gathers[i] = 0; });
    });
    for (const std::uint32_t point : seeding_->point_of_record()) gathers[point] = 1;
    return gather_scatter(points_, gathers, tile);
}

double IrradiancePass::scatter_of_all() const {
    return gather_scatter(points_, std::vector<std::uint8_t>(points_.size(), 1), tile);
}

}  // namespace regather::capture
