// capture/sampling/table_guide.h -- what the strategies that fill a table at each shaded point share: the
// table, its frame, and how the BRDF comes into it.
#pragma once
#include <vector>

#include "capture/sampling/gather_distribution.h"
#include "capture/sampling/hemisphere_table.h"

namespace regather::capture {

class TableGuide : public GatherDistribution {
public:
    void look(const ShadedPoint& point) final;
    bool sample(Strata::Point place, Sampler& sampler, GatherSample& found) const final;
    double pdf(Vec3 direction) const final { return table_.pdf(frame_.to_local(direction)); }

protected:
    /// `floor`, 0 to 1, of the density looks at no light. With `times_brdf` each cell's share is taken times
    /// the BRDF towards its middle, and the floor is of the BRDF times the cosine.
    TableGuide(std::uint32_t rows, std::uint32_t columns, double floor, bool times_brdf)
        : times_brdf_(times_brdf),
          floor_(floor),
          table_(rows, columns),
          shares_(std::size_t{rows} * columns) {}

    /// Light from each cell [any unit], which are 0.
    virtual void fill(const ShadedPoint& point, std::span<float> shares) = 0;

    const HemisphereTable& table() const { return table_; }
    const Frame& frame() const { return frame_; }
    static float brightness(Vec3 power) { return power.x + power.y + power.z; }

private:
    void multiply(const GatherPoint& at);

    bool times_brdf_;
    double floor_;
    HemisphereTable table_;
    std::vector<float> shares_;
    Frame frame_{{0, 0, 1}};
};

}  // namespace regather::capture
