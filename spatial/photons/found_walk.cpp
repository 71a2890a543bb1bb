#include "spatial/photons/found_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "spatial/walk_bits.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

std::vector<ElementRange> with_power(const Structure& searched) {
    std::vector<ElementRange> ranges(searched.ranges().begin(), searched.ranges().end());
    const ElementRange photons = searched.range_of(trace::Region::photons);
    if (photons.count == 0) return ranges;
    const std::uint32_t last = photons.first + photons.count - 1;
    const std::uint64_t records = std::uint64_t{searched.first_record(last)} + searched.records(last);
    constexpr std::uint64_t most_photons = (std::uint64_t{1} << 30) - 1;
    if (records > most_photons)
        throw trace::DataError(
            fmt::format("{}: found {} photons, expected at most {} where walks tell which were found",
                        searched.name(), records, most_photons));
    ranges.push_back({trace::Region::photon_power, searched.end(), static_cast<std::uint32_t>(records)});
    return ranges;
}

class FoundDecoder final : public WalkDecoder {
public:
    FoundDecoder(std::unique_ptr<WalkDecoder> searched, ElementRange photons, std::uint32_t first_power,
                 std::span<const std::uint32_t> record_begin)
        : searched_(std::move(searched)),
          photons_(photons),
          first_power_(first_power),
          record_begin_(record_begin) {}

    Visits decode(std::span<const std::uint8_t> walk) override {
        const auto [fault, elements] = searched_->decode(walk);
        if (fault != WalkFault::none && fault != WalkFault::bytes_left_over) return {fault, elements};
        const std::span<const std::uint8_t> found = walk.subspan(searched_->walk_bytes());
        if (padded_.size() < found.size() + walk_padding) padded_.resize(2 * (found.size() + walk_padding));
        if (!found.empty()) std::memcpy(padded_.data(), found.data(), found.size());
        std::memset(padded_.data() + found.size(), 0, walk_padding);
        const std::uint64_t total = 8 * found.size();

        visited_.assign(elements.begin(), elements.end());
        std::uint64_t position = 0;
        for (const std::uint32_t element : elements) {
            const std::uint32_t photon = element - photons_.first;
            if (photon >= photons_.count) continue;
            const std::uint32_t end = record_begin_[photon + 1];
            for (std::uint32_t record = record_begin_[photon]; record < end;) {
                const int count = static_cast<int>(std::min<std::uint32_t>(end - record, whole_bits));
                if (position + static_cast<std::uint64_t>(count) > total)
                    return {WalkFault::ends_early, visited_};
                std::uint64_t bits = bits_at(padded_.data(), position) >> (64 - count) << (64 - count);
                for (; bits != 0; bits &= ~(std::uint64_t{1} << 63 >> std::countl_zero(bits)))
                    visited_.push_back(first_power_ + record +
                                       static_cast<std::uint32_t>(std::countl_zero(bits)));
                position += static_cast<std::uint64_t>(count);
                record += static_cast<std::uint32_t>(count);
            }
        }
        walk_bytes_ = searched_->walk_bytes() + (position + 7) / 8;
        return {walk_bytes_ < walk.size() ? WalkFault::bytes_left_over : WalkFault::none, visited_};
    }

private:
    std::unique_ptr<WalkDecoder> searched_;
    ElementRange photons_;
    std::uint32_t first_power_;
    std::span<const std::uint32_t> record_begin_;
    std::vector<std::uint8_t> padded_;  // the bits of what was found, and zeros
    std::vector<std::uint32_t> visited_;
};

}  // namespace

WithFound::WithFound(std::shared_ptr<const Structure> searched, std::string name)
    : Structure(with_power(*searched)), searched_(std::move(searched)), name_(std::move(name)) {
    const ElementRange photons = range_of(trace::Region::photons);
    record_begin_.push_back(0);
    for (std::uint32_t e = photons.first; e < photons.first + photons.count; ++e)
        record_begin_.push_back(record_begin_.back() + searched_->records(e));
}

std::uint32_t WithFound::level(std::uint32_t element) const {
    if (element < searched_->end()) return searched_->level(element);
    const std::uint32_t record = element - searched_->end();
    const auto after = std::upper_bound(record_begin_.begin(), record_begin_.end(), record);
    const auto photon = static_cast<std::uint32_t>(after - record_begin_.begin()) - 1;
    return searched_->level(range_of(trace::Region::photons).first + photon);
}

std::unique_ptr<WalkDecoder> WithFound::decoder() const {
    return std::make_unique<FoundDecoder>(searched_->decoder(), range_of(trace::Region::photons),
                                          range_of(trace::Region::photon_power).first, record_begin_);
}

bool WithFound::same_as(const Structure& other) const {
    const auto* const with = dynamic_cast<const WithFound*>(&other);
    return with && Structure::same_as(other) && searched_->same_as(*with->searched_);
}

}  // namespace regather::spatial
