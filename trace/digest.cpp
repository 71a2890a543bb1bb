#include "trace/digest.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

namespace regather::trace {

std::string hexadecimal(std::uint64_t value) {
    return fmt::format("{:016x}", value);
}

std::string digest_of(std::string_view bytes) {
    return hexadecimal(XXH3_64bits(bytes.data(), bytes.size()));
}

void Digest::Free::operator()(XXH3_state_s* state) const {
    XXH3_freeState(state);
}

Digest::Digest(std::uint64_t seed) : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_64bits_reset_withSeed(state_.get(), seed);
}

void Digest::add_bytes(std::span<const std::byte> bytes) {
    XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
}

std::uint64_t Digest::value() const {
    return XXH3_64bits_digest(state_.get());
}

std::string Digest::hexadecimal() const {
    return trace::hexadecimal(value());
}

}  // namespace regather::trace
