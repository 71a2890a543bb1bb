#include "capture/irradiance/waiting_pixels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <vector>

namespace regather::capture {
namespace {

/// A record at each point, as far as it is known before anything is gathered.
std::vector<IrradianceRecord> foreseen_records(std::span<const SeedPoint> points,
                                               const IrradianceOctree& octree) {
    std::vector<IrradianceRecord> records(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const IrradiancePoint& point = points[i].point;
        double least = std::numeric_limits<double>::infinity();
        octree.search(point, octree.tolerance(), [&](std::uint32_t r) {
            if (const double error = error_at(octree.record(r), point); error < least) {
                least = error;
                records[i] = octree.record(r);
            }
        });
        records[i].position = point.position;
        records[i].normal = point.normal;
    });
    return records;
}

std::vector<std::uint32_t> in_tiles(std::span<const SeedPoint> points, std::uint32_t tile) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key = [&](const SeedPoint& at) {
            return std::tuple(at.row / tile, at.column / tile, at.row, at.column);
        };
        return key(points[a]) < key(points[b]);
    });
    return order;
}

/// The time line. Without a buffer a point waits for no record that is in the making.
class Waiting {
public:
    Waiting(std::span<const IrradianceRecord> foreseen, const trace::Bounds3& box, double tolerance,
            const WaitingConfig& config, bool holds)
        : foreseen_(foreseen), config_(config), holds_(holds), finished_(box, tolerance, false) {}

    void look_up(std::uint32_t number) {
        const IrradiancePoint point{foreseen_[number].position, foreseen_[number].normal};
        for (;;) {
            finish_what_is_due();
            if (is_served(point)) break;
            const Making* const serving = holds_ ? find_serving(point) : nullptr;
            if (!serving) {
                making_.push_back({time_ + config_.latency, number});
                ++records;
                break;
            }
            if (leaving_.size() < config_.entries) {
                waits.push_back(serving->end - time_);
                leaving_.push(serving->end);
                most_waiting = std::max<std::uint64_t>(most_waiting, leaving_.size());
                break;
            }
            stopped += leaving_.top() - time_;
            time_ = leaving_.top();
        }
        ++time_;
    }

    std::uint64_t records = 0, most_waiting = 0, stopped = 0;
    std::vector<std::uint64_t> waits;

private:
    struct Making {
        std::uint64_t end;
        std::uint32_t number;
    };

    void finish_what_is_due() {
        for (; !making_.empty() && making_.front().end <= time_; making_.pop_front())
            finished_.insert(foreseen_[making_.front().number]);
        while (!leaving_.empty() && leaving_.top() <= time_) leaving_.pop();
    }
    bool is_served(const IrradiancePoint& point) const {
        bool found = false;
        finished_.search(point, finished_.tolerance(), [&](std::uint32_t) { found = true; });
        return found;
    }
    /// The one that ends first: all take as long.
    const Making* find_serving(const IrradiancePoint& point) const {
        const auto found = std::find_if(making_.begin(), making_.end(), [&](const Making& record) {
            return serves(foreseen_[record.number], point, finished_.tolerance());
        });
        return found == making_.end() ? nullptr : &*found;
    }

    std::span<const IrradianceRecord> foreseen_;
    const WaitingConfig& config_;
    bool holds_;
    IrradianceOctree finished_;
    std::uint64_t time_ = 0;
    std::deque<Making> making_;
    std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> leaving_;
};

}  // namespace

WaitingPixels waiting_pixels(std::span<const SeedPoint> points, const IrradianceOctree& octree,
                             const trace::Bounds3& box, const WaitingConfig& config) {
    const std::vector<IrradianceRecord> foreseen = foreseen_records(points, octree);
    Waiting held(foreseen, box, octree.tolerance(), config, true);
    Waiting unheld(foreseen, box, octree.tolerance(), config, false);
    for (const std::uint32_t number : in_tiles(points, config.tile)) {
        held.look_up(number);
        unheld.look_up(number);
    }
    std::vector<std::uint64_t>& waits = held.waits;
    std::sort(waits.begin(), waits.end());
    // The least wait that so many of a hundred do not exceed.
    const auto percentile = [&](std::size_t of_hundred) {
        return waits.empty() ? 0 : waits[(waits.size() * of_hundred + 99) / 100 - 1];
    };
    return {points.size(),  held.records,   unheld.records, waits.size(),    held.most_waiting,
            percentile(50), percentile(90), percentile(99), percentile(100), held.stopped};
}

}  // namespace regather::capture
