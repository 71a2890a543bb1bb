#include "results/machine_row.h"

#include <array>

#include "results/machine_columns.h"

namespace regather::results {
namespace {

constexpr auto machine_columns = with_machine_counts<MachineRow>(std::array{
    column<&MachineRow::scene>("scene"),
    column<&MachineRow::structure>("structure"),
    column<&MachineRow::layout>("layout"),
    column<&MachineRow::ordering>("ordering"),
    column<&MachineRow::parameters>("parameters"),
    column<&MachineRow::machine>("machine", needed),
    column<&MachineRow::level>("level", needed),
    column<&MachineRow::region>("region", needed),
});

}  // namespace

const RowKind& MachineRow::kind() {
    static constexpr RowKind kind{"machine", machine_columns};
    return kind;
}

}  // namespace regather::results
