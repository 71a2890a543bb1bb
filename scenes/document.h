// scenes/document.h -- texts of files in messages, under the name that readers of scenes use.
#pragma once
#include "trace/text.h"

namespace regather::scenes {

using trace::in_quotes;

}  // namespace regather::scenes
