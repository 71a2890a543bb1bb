// imports/homes/vocabulary.h -- which elements and attributes of a Sweet Home 3D home are read, and which say
// nothing of what is seen; all others, of later versions too, are counted as left out.
#pragma once
#include "imports/homes/element.h"
#include "imports/left_out.h"

namespace regather::imports {

/// Of all elements below `home`. DataError for an attribute that stands twice in its element.
void count_left_out(const XmlDocument& home, LeftOut& left_out);

}  // namespace regather::imports
