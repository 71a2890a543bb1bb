#include "results/machine_row.h"

namespace regather::results {
namespace {

constexpr Column columns[] = {
    column<&MachineRow::scene>("scene"),
    column<&MachineRow::structure>("structure"),
    column<&MachineRow::layout>("layout"),
    column<&MachineRow::ordering>("ordering"),
    column<&MachineRow::parameters>("parameters"),
    column<&MachineRow::machine>("machine", needed),
    column<&MachineRow::level>("level", needed),
    column<&MachineRow::region>("region", needed),
    column<&MachineRow::accesses>("accesses"),
    column<&MachineRow::hits>("hits"),
    column<&MachineRow::misses>("misses"),
    column<&MachineRow::sector_misses>("sector_misses"),
    column<&MachineRow::victim_hits>("victim_hits"),
    column<&MachineRow::writebacks>("writebacks"),
    column<&MachineRow::clean_victims>("clean_victims"),
    column<&MachineRow::writes_through>("writes_through"),
    column<&MachineRow::back_invalidations>("back_invalidations"),
    column<&MachineRow::prefetches>("prefetches"),
    column<&MachineRow::useful_prefetches>("useful_prefetches"),
    column<&MachineRow::bytes_in>("bytes_in"),
    column<&MachineRow::bytes_out>("bytes_out"),
    column<&MachineRow::bursts_read>("bursts_read"),
    column<&MachineRow::bursts_written>("bursts_written"),
    column<&MachineRow::row_hits>("row_hits"),
    column<&MachineRow::row_empty>("row_empty"),
    column<&MachineRow::row_conflicts>("row_conflicts"),
    column<&MachineRow::picojoules>("picojoules"),
};

}  // namespace

const RowKind& MachineRow::kind() {
    static constexpr RowKind kind{"machine", columns};
    return kind;
}

}  // namespace regather::results
