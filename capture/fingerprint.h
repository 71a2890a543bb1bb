// capture/fingerprint.h -- whether two builds render alike, told in less than a second: a digest of what they
// make of one scene at 16 x 16 pixels. A capture keeps it, so that results which a change of the renderer has
// outdated are found without capturing again.
#pragma once
#include <string>

#include "scenes/scene.h"

namespace regather::capture {

/// XXH3-64 in hexadecimal over three pictures of the scene, by its standing camera and with few photons and
/// rays: final gathers, direct visualisation and paths; with how many photons were stored and found, queries
/// made and nodes visited. Two builds that differ in it render differently. Two that agree may still differ
/// in what so small a picture does not reach: many pixels, many photons, options that are not the defaults.
std::string fingerprint(const scenes::Scene& scene);

}  // namespace regather::capture
