// meshes/notes.h -- what stands in a file and is not taken over: one line a kind, with how often.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace regather::meshes {

class Notes {
public:
    /// `kind`: a whole statement, such as "lines (l) are not read".
    void add(std::string_view kind, std::uint64_t times = 1);
    /// "KIND: 12", in the order of their first appearance; beyond the first 24 kinds one line for all others.
    std::vector<std::string> lines() const;

private:
    std::vector<std::pair<std::string, std::uint64_t>> kinds_;
    std::uint64_t others_ = 0;
};

}  // namespace regather::meshes
