#include "cachesim/policies/policy_sweep.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <bit>
#include <variant>

#include "cachesim/cache.h"
#include "cachesim/line_ids.h"
#include "cachesim/policies/opt_cache.h"
#include "cachesim/policies/policy_cache.h"

namespace regather::cachesim {

namespace {

constexpr std::size_t batch_lines = 1 << 16;

/// Line accesses in a row, an entry each.
struct Batch {
    std::vector<Line> lines;
    std::vector<Access> kinds;
    std::vector<std::uint32_t> bytes;
    std::vector<std::uint32_t> missing;  // as FullLru says it; empty without classes
};

bool runs_as_lru_cache(const PolicyConfig& config) {
    return config.policy == Policy::lru && config.write == WritePolicy::back &&
           config.write_miss == WriteMiss::allocate && config.index == SetIndex::modulo &&
           std::has_single_bit(config.sets());
}

/// One cache and what is counted of it.
class Simulation {
public:
    Simulation(const PolicyConfig& config, std::size_t row, std::uint32_t size_rank)
        : config_(config), row_(row), size_rank_(size_rank) {
        if (runs_as_lru_cache(config))
            cache_.emplace<LruCache>(config.geometry);
        else if (config.policy != Policy::opt)
            cache_.emplace<PolicyCache>(config);
    }

    void access(const Batch& batch) {
        if (config_.policy == Policy::opt) return;
        auto* const lru = std::get_if<LruCache>(&cache_);
        if (lru && batch.missing.empty()) return access_at_once(*lru, batch);
        missed_.resize(batch.lines.size());
        if (lru) {
            for (std::size_t i = 0; i < missed_.size(); ++i) {
                const std::uint64_t before = lru->stats(trace::Region::other).misses;
                lru->access({&batch.lines[i], 1}, trace::Region::other, batch.kinds[i]);
                missed_[i] = lru->stats(trace::Region::other).misses != before;
            }
        } else {
            auto& cache = std::get<PolicyCache>(cache_);
            for (std::size_t i = 0; i < missed_.size(); ++i)
                missed_[i] =
                    !cache.access(batch.lines[i], batch.kinds[i], trace::Region::other, batch.bytes[i]).hit;
        }
        classify(batch.missing);
    }

    void begin_opt(const OptStream& stream) { cache_.emplace<OptCache>(config_, stream); }
    void access_opt(std::size_t accesses, std::span<const std::uint32_t> missing) {
        missed_.resize(accesses);
        std::get<OptCache>(cache_).access(missed_);
        classify(missing);
    }

    PolicyRow finish(bool classified) {
        PolicyRow row{config_, {}, {}};
        if (classified) row.classes = classes_;
        if (auto* const lru = std::get_if<LruCache>(&cache_)) {
            lru->flush();
            const CacheStats total = lru->total();
            row.stats = {total.accesses, total.misses, total.misses, total.writebacks, 0, 0};
        } else if (auto* const opt = std::get_if<OptCache>(&cache_)) {
            opt->flush();
            row.stats = opt->total();
        } else {
            auto& cache = std::get<PolicyCache>(cache_);
            cache.flush();
            row.stats = cache.total();
        }
        return row;
    }

    bool is_opt() const { return config_.policy == Policy::opt; }
    std::size_t row() const { return row_; }

private:
    static void access_at_once(LruCache& cache, const Batch& batch) {
        if (std::find(batch.kinds.begin(), batch.kinds.end(), Access::write) != batch.kinds.end())
            cache.access(batch.lines, batch.kinds, trace::Region::other);
        else
            cache.access(batch.lines, trace::Region::other);
    }

    void classify(std::span<const std::uint32_t> missing) {
        if (missing.empty()) return;
        MissClasses sum;
        for (std::size_t i = 0; i < missed_.size(); ++i) {
            const std::uint64_t missed = missed_[i];
            const bool first = missing[i] == FullLru::first_touch, full = missing[i] > size_rank_;
            sum.compulsory += missed & first;
            sum.capacity += missed & (full & !first);
            sum.conflict += missed & !full;
        }
        classes_ += sum;
    }

    PolicyConfig config_;
    std::size_t row_;
    std::uint32_t size_rank_;  // of its size among those of FullLru
    std::variant<std::monostate, LruCache, PolicyCache, OptCache> cache_;
    std::vector<std::uint8_t> missed_;
    MissClasses classes_;
};

std::vector<std::uint64_t> capacities_of(std::span<const PolicyConfig> configs, std::uint32_t line_bytes) {
    std::vector<std::uint64_t> capacities;
    for (const PolicyConfig& config : configs)
        if (config.geometry.line_bytes == line_bytes)
            capacities.push_back(config.geometry.size_bytes / line_bytes);
    std::sort(capacities.begin(), capacities.end());
    capacities.erase(std::unique(capacities.begin(), capacities.end()), capacities.end());
    return capacities;
}

}  // namespace

class PolicySweep::Group {
public:
    Group(std::span<const PolicyConfig> configs, std::uint32_t line_bytes, const PolicySweepOptions& options)
        : line_bytes_(line_bytes),
          classifies_(options.classes),
          capacities_(capacities_of(configs, line_bytes)),
          full_(capacities_),
          stream_(options.opt_limit) {
        for (std::size_t row = 0; row < configs.size(); ++row) {
            const CacheConfig& geometry = configs[row].geometry;
            if (geometry.line_bytes != line_bytes) continue;
            const auto rank =
                std::lower_bound(capacities_.begin(), capacities_.end(), geometry.size_bytes / line_bytes) -
                capacities_.begin();
            simulations_.emplace_back(configs[row], row, static_cast<std::uint32_t>(rank));
            keeps_stream_ = keeps_stream_ || simulations_.back().is_opt();
        }
    }

    std::uint32_t line_bytes() const { return line_bytes_; }
    std::uint64_t kept() const { return stream_.size(); }

    void access(std::span<const ByteAccess> accesses) {
        for (const ByteAccess& access : accesses) {
            std::uint64_t address = access.address, left = access.bytes;
            for_each_line(access.address, access.bytes, line_bytes_, [&](Line line) {
                const std::uint64_t here = std::min(left, line_bytes_ - address % line_bytes_);
                append(line, access.kind, static_cast<std::uint32_t>(here));
                address += here;
                left -= here;
                if (batch_.lines.size() == batch_lines) run();
            });
        }
        run();
    }

    /// opt, with `done` called for each piece of the stream.
    void finish(const std::function<void(std::uint64_t)>& done) {
        if (!keeps_stream_) return;
        stream_.finish();
        FullLru full(capacities_);
        tbb::parallel_for_each(simulations_, [&](Simulation& s) {
            if (s.is_opt()) s.begin_opt(stream_);
        });
        std::vector<std::uint32_t> missing;
        for (std::uint64_t begin = 0; begin < stream_.size();) {
            const std::uint64_t end = std::min(begin + batch_lines, stream_.size());
            missing.clear();
            for (std::uint64_t i = begin; classifies_ && i < end; ++i)
                missing.push_back(full.access(stream_.id(i)));
            tbb::parallel_for_each(simulations_, [&](Simulation& s) {
                if (s.is_opt()) s.access_opt(end - begin, missing);
            });
            done(end - begin);
            begin = end;
        }
    }

    void collect(std::span<PolicyRow> rows) {
        for (Simulation& simulation : simulations_) rows[simulation.row()] = simulation.finish(classifies_);
    }

private:
    void append(Line line, Access kind, std::uint32_t bytes) {
        if (classifies_ || keeps_stream_) {
            const std::uint32_t id = ids_(line);
            if (keeps_stream_) stream_.append(line, id, kind, bytes);
            if (classifies_) batch_.missing.push_back(full_.access(id));
        }
        batch_.lines.push_back(line);
        batch_.kinds.push_back(kind);
        batch_.bytes.push_back(bytes);
    }

    void run() {
        tbb::parallel_for_each(simulations_, [&](Simulation& simulation) { simulation.access(batch_); });
        batch_.lines.clear();
        batch_.kinds.clear();
        batch_.bytes.clear();
        batch_.missing.clear();
    }

    std::uint32_t line_bytes_;
    bool classifies_;
    std::vector<std::uint64_t> capacities_;  // in lines
    LineIds ids_;
    FullLru full_;
    OptStream stream_;
    bool keeps_stream_ = false;
    Batch batch_;
    std::vector<Simulation> simulations_;
};

PolicySweep::PolicySweep(std::span<const PolicyConfig> configs, const PolicySweepOptions& options)
    : configs_(configs.begin(), configs.end()) {
    for (const PolicyConfig& config : configs_) {
        check(config);
        const std::uint32_t line_bytes = config.geometry.line_bytes;
        if (std::none_of(groups_.begin(), groups_.end(),
                         [&](const auto& group) { return group->line_bytes() == line_bytes; }))
            groups_.push_back(std::make_unique<Group>(configs_, line_bytes, options));
    }
}
PolicySweep::~PolicySweep() = default;
PolicySweep::PolicySweep(PolicySweep&&) noexcept = default;
PolicySweep& PolicySweep::operator=(PolicySweep&&) noexcept = default;

void PolicySweep::access(std::span<const ByteAccess> accesses) {
    tbb::parallel_for_each(groups_, [&](auto& group) { group->access(accesses); });
}

std::vector<PolicyRow> PolicySweep::finish(
    const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
    std::uint64_t done = 0, total = 0;
    for (const auto& group : groups_) total += group->kept();
    for (const auto& group : groups_)
        group->finish([&](std::uint64_t more) { progress(done += more, total); });
    std::vector<PolicyRow> rows(configs_.size());
    for (const auto& group : groups_) group->collect(rows);
    return rows;
}

}  // namespace regather::cachesim
