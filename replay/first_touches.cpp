#include "replay/first_touches.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdlib>
#include <limits>
#include <mutex>

#include "replay/walk_run.h"

namespace regather::replay {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{32} << 20, huge_page = std::size_t{2} << 20;
constexpr std::size_t together = std::size_t{256} << 10;  // bytes of walks that find their place at once
constexpr std::uint64_t bytes_a_place = 64;  // of all that may be held, for each place of a walk at least

}  // namespace

void FirstTouches::Free::operator()(std::uint8_t* chunk) const {
    std::free(chunk);
}

/// Gives packed walks their places in chunks of memory. Any number of threads.
class FirstTouches::Maker {
public:
    Maker(FirstTouches& of, std::uint64_t most_bytes) : of_(of), most_bytes_(most_bytes) {}

    /// Consecutive walks on their way, and what one thread finds.
    struct Part {
        std::vector<WalkLines> sizes;
        std::vector<std::uint32_t> numbers;
        std::vector<std::uint8_t> packed;
        std::vector<std::size_t> starts;
        std::uint64_t first_query = 0;
        Totals totals;
    };

    void add(Part& part, const Layout& layout, std::uint64_t query, std::span<const std::uint32_t> elements) {
        if (query != part.first_query + part.starts.size() || part.packed.size() >= together) {
            place(part);
            part.first_query = query;
        }
        part.totals.visited_nodes += elements.size();
        part.totals.raw_bytes += layout.bytes(elements);
        const bool held = query < of_.places_.size() && !full_;
        part.starts.push_back(part.packed.size());
        for (std::size_t s = 0; s < part.sizes.size(); ++s) {
            const std::span<const cachesim::Line> touches = part.sizes[s].touches(elements);
            part.totals.accesses[s] += touches.size();
            if (held) append(part, part.sizes[s].first(touches), of_.first_lines_[s]);
        }
        if (!held) part.starts.pop_back();
    }

    /// Copies the walks of a part to where they stay, if there is room.
    void place(Part& part) {
        if (std::uint8_t* const to = part.starts.empty() ? nullptr : room(part.packed.size())) {
            std::memcpy(to, part.packed.data(), part.packed.size());
            for (std::size_t i = 0; i < part.starts.size(); ++i)
                of_.places_[part.first_query + i] = to + part.starts[i];
            const std::lock_guard lock(mutex_);
            of_.held_queries_ += part.starts.size();
        }
        part.packed.clear();
        part.starts.clear();
    }

private:
    static void append(Part& part, const WalkLines::First& first, std::uint64_t first_line) {
        part.numbers.clear();
        std::uint32_t greatest = 0;
        for (const cachesim::Line line : first.lines) {
            const auto number = static_cast<std::uint32_t>(static_cast<std::uint64_t>(line) - first_line);
            greatest = std::max(greatest, number);
            part.numbers.push_back(number);
        }
        const auto lines = static_cast<std::uint32_t>(first.lines.size());
        const Head head{lines, static_cast<std::uint8_t>(packed_width(greatest)),
                        static_cast<std::uint8_t>(packed_width(lines == 0 ? 0 : lines - 1)), 0};
        const std::size_t at = part.packed.size();
        part.packed.resize(at + sizeof head);
        std::memcpy(part.packed.data() + at, &head, sizeof head);
        pack(part.numbers, head.line_bits, part.packed);
        pack(first.last_rank, head.rank_bits, part.packed);
    }

    /// Null when there is no more.
    std::uint8_t* room(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        if (bytes > left_) {
            const std::size_t more =
                (std::max(chunk_bytes, bytes + read_past) + huge_page - 1) / huge_page * huge_page;
            if (full_ || of_.bytes_ + more > most_bytes_) {
                full_ = true;
                return nullptr;
            }
            auto* const chunk = static_cast<std::uint8_t*>(std::aligned_alloc(huge_page, more));
            if (chunk == nullptr) {
                full_ = true;
                return nullptr;
            }
            ::madvise(chunk, more, MADV_HUGEPAGE);  // where the system does not, small pages do
            of_.chunks_.emplace_back(chunk);
            of_.bytes_ += more;
            next_ = chunk;
            left_ = more - read_past;
        }
        std::uint8_t* const found = next_;
        next_ += bytes;
        left_ -= bytes;
        return found;
    }

    static constexpr std::size_t read_past = packed_padding;
    FirstTouches& of_;
    std::uint64_t most_bytes_;
    std::mutex mutex_;
    std::atomic<bool> full_ = false;
    std::uint8_t* next_ = nullptr;
    std::size_t left_ = 0;
};

FirstTouches::FirstTouches(const WalkStore& walks, const Layout& layout,
                           std::span<const std::uint32_t> line_sizes, std::uint64_t most_bytes,
                           const QueriesDone& progress)
    : line_sizes_(line_sizes.begin(), line_sizes.end()) {
    bool numbers_fit = true;
    for (const std::uint32_t line_bytes : line_sizes) {
        const int shift = std::countr_zero(line_bytes);
        first_lines_.push_back(layout.first_byte() >> shift);
        numbers_fit = numbers_fit && (layout.end_byte() >> shift) - first_lines_.back() <=
                                         std::numeric_limits<std::uint32_t>::max();
    }
    places_.resize(numbers_fit ? std::min(walks.queries(), most_bytes / bytes_a_place) : 0);
    bytes_ = places_.size() * sizeof places_[0];
    totals_.accesses.resize(line_sizes_.size());

    Maker maker(*this, most_bytes);
    tbb::enumerable_thread_specific<Maker::Part> parts([&] {
        Maker::Part part;
        for (const std::uint32_t line_bytes : line_sizes_) part.sizes.emplace_back(layout, line_bytes);
        part.totals.accesses.resize(line_sizes_.size());
        return part;
    });
    run_all_walks(walks, parts, progress,
                  [&](Maker::Part& part, std::uint64_t query, std::span<const std::uint32_t> elements) {
                      maker.add(part, layout, query, elements);
                  });
    for (Maker::Part& part : parts) {
        maker.place(part);
        totals_.visited_nodes += part.totals.visited_nodes;
        totals_.raw_bytes += part.totals.raw_bytes;
        for (std::size_t s = 0; s < line_sizes_.size(); ++s) totals_.accesses[s] += part.totals.accesses[s];
    }
}

}  // namespace regather::replay
