// trace/digest.h -- what stands for many bytes: XXH3-64 of them, seed 0 unless said, in 16 hexadecimal
// digits.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "trace/vec.h"

struct XXH3_state_s;  // of xxhash.h

namespace regather::trace {

/// 16 digits, the highest first, in lower case.
std::string hexadecimal(std::uint64_t value);

/// XXH3-64 of a text's bytes, in hexadecimal.
std::string digest_of(std::string_view bytes);

/// A value without bytes between its parts that could hold anything.
template <class T>
concept WithoutPadding = std::has_unique_object_representations_v<T> || std::same_as<T, float> ||
    std::same_as<T, double> || std::same_as<T, Vec3>;

/// Of bytes that come piece by piece; where one piece ends and the next begins makes no difference.
class Digest {
public:
    explicit Digest(std::uint64_t seed = 0);

    void add_bytes(std::span<const std::byte> bytes);
    /// The bytes of a value as they lie in memory.
    template <WithoutPadding T>
    void add(const T& value) {
        add_bytes(std::as_bytes(std::span(&value, 1)));
    }
    /// Of several; their number is not added.
    template <WithoutPadding T>
    void add_all(std::span<const T> values) {
        add_bytes(std::as_bytes(values));
    }

    std::uint64_t value() const;
    std::string hexadecimal() const;

private:
    struct Free {
        void operator()(XXH3_state_s* state) const;
    };
    std::unique_ptr<XXH3_state_s, Free> state_;
};

}  // namespace regather::trace
