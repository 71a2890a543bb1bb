// tests/tsan/tbb/threads.h -- the part of oneTBB that this project calls, over std::thread, for
// ThreadSanitizer. Debian's libtbb is not compiled with it: what its scheduler orders looks unordered, and
// every loop would be reported. Here each loop has threads that ThreadSanitizer sees begin and end, so a
// report is a race of ours. The preset `tsan` takes this folder in place of oneTBB's headers. Not meant to be
// fast.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <iterator>
#include <list>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {
namespace threads {

/// At least four, so that loops run side by side on any machine.
inline unsigned most() {
    return std::max(4u, std::thread::hardware_concurrency());
}
inline std::atomic<unsigned> allowed{~0u};    // by global_control
inline thread_local unsigned in_arena = ~0u;  // by task_arena
inline thread_local int depth = 0;            // a loop within a loop within a loop runs on its own thread

inline unsigned count() {
    return std::max(1u, std::min({most(), allowed.load(), in_arena}));
}

/// The exception of any task, thrown to the caller when all have ended.
class Failure {
public:
    template <class Task>
    void keep(Task&& task) {
        try {
            task();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!first_) first_ = std::current_exception();
        }
    }
    void raise() {
        if (first_) std::rethrow_exception(std::exchange(first_, nullptr));
    }

private:
    std::mutex mutex_;
    std::exception_ptr first_;
};

/// task(0) ... task(tasks - 1), in no order.
template <class Task>
void run(std::size_t tasks, const Task& task) {
    std::atomic<std::size_t> next{0};
    Failure failure;
    const auto work = [&, depth_outside = depth, arena = in_arena] {
        depth = depth_outside + 1;
        in_arena = arena;
        for (std::size_t i; (i = next.fetch_add(1)) < tasks;) failure.keep([&] { task(i); });
        depth = depth_outside;
    };
    const std::size_t workers = depth < 2 ? std::min<std::size_t>(count(), tasks) : 1;
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < workers; ++i) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    failure.raise();
}

}  // namespace threads

template <class Value>
class blocked_range {
public:
    blocked_range(Value begin, Value end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
    Value begin() const { return begin_; }
    Value end() const { return end_; }
    std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
    std::size_t grainsize() const { return grain_; }

private:
    Value begin_, end_;
    std::size_t grain_;
};

namespace threads {
/// Parts of a range of about its grain, and no more than 64.
template <class Range>
std::vector<Range> parts(const Range& range) {
    const std::size_t size = range.size(), grain = std::max(range.grainsize(), (size + 63) / 64);
    std::vector<Range> result;
    for (std::size_t at = 0; at < size; at += grain)
        result.emplace_back(static_cast<decltype(range.begin())>(range.begin() + at),
                            static_cast<decltype(range.begin())>(range.begin() + std::min(size, at + grain)),
                            range.grainsize());
    return result;
}
}  // namespace threads

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body) {
    const auto parts = threads::parts(range);
    threads::run(parts.size(), [&](std::size_t i) { body(parts[i]); });
}
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
    if (first >= last) return;
    parallel_for(blocked_range<Index>(first, last), [&](const blocked_range<Index>& part) {
        for (Index i = part.begin(); i != part.end(); ++i) body(i);
    });
}
template <class Iterator, class Body>
void parallel_for_each(Iterator first, Iterator last, const Body& body) {
    std::vector<Iterator> all;
    for (; first != last; ++first) all.push_back(first);
    threads::run(all.size(), [&](std::size_t i) { body(*all[i]); });
}
template <class Container, class Body>
void parallel_for_each(Container&& container, const Body& body) {
    parallel_for_each(std::begin(container), std::end(container), body);
}
template <class... Tasks>
void parallel_invoke(const Tasks&... tasks) {
    const std::vector<std::function<void()>> all{std::cref(tasks)...};
    threads::run(all.size(), [&](std::size_t i) { all[i](); });
}
template <class Range, class Value, class Body, class Join>
Value parallel_reduce(const Range& range, const Value& identity, const Body& body, const Join& join) {
    const auto parts = threads::parts(range);
    std::vector<Value> found(parts.size(), identity);
    threads::run(parts.size(), [&](std::size_t i) { found[i] = body(parts[i], identity); });
    Value result = identity;
    for (const Value& part : found) result = join(result, part);
    return result;
}
template <class Iterator, class... Less>
void parallel_sort(Iterator first, Iterator last, Less... less) {
    std::sort(first, last, less...);
}

template <class Value>
class enumerable_thread_specific {
public:
    enumerable_thread_specific() : make_([] { return Value(); }) {}
    template <class Make>
    explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}

    Value& local() {
        const std::lock_guard lock(mutex_);
        for (auto& [owner, value] : values_)
            if (owner == std::this_thread::get_id()) return value;
        return values_.emplace_back(std::this_thread::get_id(), make_()).second;
    }

    class iterator {
    public:
        using Inner = typename std::list<std::pair<std::thread::id, Value>>::iterator;
        explicit iterator(Inner at) : at_(at) {}
        Value& operator*() const { return at_->second; }
        iterator& operator++() { return ++at_, *this; }
        bool operator!=(const iterator& other) const { return at_ != other.at_; }

    private:
        Inner at_;
    };
    iterator begin() { return iterator(values_.begin()); }
    iterator end() { return iterator(values_.end()); }

private:
    std::mutex mutex_;
    std::list<std::pair<std::thread::id, Value>> values_;
    std::function<Value()> make_;
};

class task_group {
public:
    ~task_group() { join(); }
    template <class Task>
    void run(Task task) {
        if (threads::depth >= 4)
            return failure_.keep(task);  // a recursion needs no thread for each of its leaves
        others_.emplace_back([this, task = std::move(task), depth = threads::depth + 1]() mutable {
            threads::depth = depth;
            failure_.keep(task);
        });
    }
    void wait() {
        join();
        failure_.raise();
    }

private:
    void join() {
        for (std::thread& other : others_) other.join();
        others_.clear();
    }
    std::vector<std::thread> others_;
    threads::Failure failure_;
};

class task_arena {
public:
    explicit task_arena(int most = static_cast<int>(threads::most())) : most_(static_cast<unsigned>(most)) {}
    template <class Task>
    auto execute(Task&& task) {
        struct Back {
            unsigned before;
            ~Back() { threads::in_arena = before; }
        } back{std::exchange(threads::in_arena, most_)};
        return task();
    }

private:
    unsigned most_;
};
namespace this_task_arena {
inline int max_concurrency() {
    return static_cast<int>(threads::count());
}
}  // namespace this_task_arena

class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t most)
        : before_(threads::allowed.exchange(static_cast<unsigned>(most))) {}
    ~global_control() { threads::allowed = before_; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;

private:
    unsigned before_;
};

}  // namespace tbb
