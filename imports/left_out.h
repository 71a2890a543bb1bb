// imports/left_out.h -- what a file says and an importer does not use, counted and told in one line a kind:
// nothing is passed over in silence, whatever a later version of a format adds.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace regather::imports {

class LeftOut {
public:
    /// `count` more of `name` (of the file: any bytes) in `kind` (ours: "of wall").
    void add(std::string_view kind, std::string_view name, std::uint64_t count = 1);

    /// A note of a reader of models, "WHAT: COUNT" or "WHAT": those of all models are told together.
    void add_note_of_model(std::string_view note);

    /// "left out of wall: <baseboard> (54 times), glow (once)": kinds and names sorted; of each line the
    /// first 60 names, cut to 40 bytes, with control characters and what is no UTF-8 escaped.
    std::vector<std::string> lines() const;

private:
    struct OfModels {
        std::uint64_t count = 0, models = 0;
    };
    std::map<std::string, std::map<std::string, std::uint64_t, std::less<>>, std::less<>> kinds_;
    std::map<std::string, OfModels, std::less<>> notes_;
};

}  // namespace regather::imports
