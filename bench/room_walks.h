// bench/room_walks.h -- the walks of bench/room.h as a replay takes them.
#pragma once
#include "bench/room.h"
#include "replay/layout.h"
#include "replay/walk_store.h"
#include "spatial/photons/left_balanced.h"

namespace regather::bench {

inline std::shared_ptr<const spatial::Structure> tree() {
    static const auto instance = std::make_shared<spatial::LeftBalanced>(photon_count);
    return instance;
}

inline replay::WalkStore walks() {
    return {tree(), room().recording.walk_bytes, room().recording.walks};
}

inline replay::Layout heap_20() {
    return replay::heap_20(*tree());
}

}  // namespace regather::bench
