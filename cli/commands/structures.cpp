// regather structures -- what photons can be searched in, and rays cast through.
#include "spatial/photons/structures.h"

#include <memory>

#include "cli/command.h"
#include "cli/commands.h"
#include "results/table.h"
#include "spatial/rays/ray_structures.h"

namespace regather::cli {
namespace {

struct StructuresOptions {};

void list_structures(const StructuresOptions&, const Console& console) {
    using results::Align;
    results::Table all({{"structure", Align::left},
                        {"version", Align::right},
                        {"exact", Align::left},
                        {"parameters", Align::left},
                        {"what", Align::left}});
    const auto add = [&all](const auto& entry, std::string_view exact) {
        std::string parameters;
        for (const trace::Parameter& parameter : entry.parameters)
            parameters += fmt::format("{}{}{}{}", parameters.empty() ? "" : ",", parameter.name,
                                      parameter.default_value.empty() ? "" : "=", parameter.default_value);
        all.add({std::string(entry.name), fmt::format("{}", entry.version), std::string(exact), parameters,
                 std::string(entry.summary)});
    };
    for (const spatial::StructureEntry& entry : spatial::structures())
        add(entry, !entry.build ? "?" : entry.is_exact ? "yes" : "no");
    for (const spatial::RayStructureEntry& entry : spatial::ray_structures()) add(entry, "yes");
    console.print("{}", results::text_of(all));
}

}  // namespace

void add_structures(Command& command) {
    command.footer(
        "Examples:\n  regather structures          # their names, for:\n  regather walk out/room/trace "
        "--structure median-kd:leaf=8 -o out/room-median\n"
        "  regather walk out/room/trace --rays gather --structure bvh-4 -o out/room-gather-rays");
    command.action(std::make_shared<StructuresOptions>(), list_structures);
}

}  // namespace regather::cli
