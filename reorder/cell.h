// reorder/cell.h -- the cells of query positions (spatial/cell.h).
#pragma once
#include "spatial/cell.h"

namespace regather::reorder {

using spatial::Cell;
using spatial::CellGrid;

}  // namespace regather::reorder
