// charts/ladder_look.h -- settings of the renderer as curves: their looks and what stands under the title.
#pragma once
#include <span>
#include <string>

#include "charts/figure.h"
#include "results/ladder.h"

namespace regather::charts {

/// Direct visualisation, without final gathers.
bool is_direct(const results::Ladder& ladder);

/// The look of what is varied is the same in every chart; `place` among the ladders picks that of an unknown
/// one.
Line line_of(const results::Ladder& ladder, std::size_t place);

/// "box, 64×64 pixels · 4 seeds"
std::string caption(std::span<const results::Ladder> all);

}  // namespace regather::charts
