// cachesim/machines/machine.h -- a memory system as data: the levels of its caches, its DRAM, and where each
// figure is from. Read from JSON, strictly: docs/machines.md has the format. Some are part of the binary:
// cachesim/machines/*.json.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cachesim/machines/hierarchy.h"

namespace regather::cachesim {

/// Where the figure of a key is from ("size_bytes", "Intel ... manual ..."); "assumed: ..." where nobody
/// says.
struct Source {
    std::string key, text;
};

struct Machine {
    std::string name, summary;
    std::vector<LevelConfig> levels;           ///< Nearest first.
    std::vector<std::vector<Source>> sources;  ///< By level.
    std::optional<DramConfig> dram;
    std::vector<Source> dram_sources;

    Hierarchy hierarchy() const { return Hierarchy(levels, dram); }
};

struct EmbeddedMachine {
    std::string_view name, text;  ///< The JSON file.
};

/// The one table of embedded machines.
std::span<const EmbeddedMachine> machine_catalogue();

/// An embedded machine's name, or a path of a JSON file. Throws trace::DataError "FILE: FIELD: found X,
/// expected Y" for a bad file, and trace::UsageError for a word that is neither and looks like a name: it has
/// no '/' and does not end in .json.
Machine load_machine(std::string_view name_or_path);

/// The same from the text of a file that is called `file` in messages.
Machine parse_machine(std::string_view text, const std::string& file);

}  // namespace regather::cachesim
