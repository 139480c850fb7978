// Tells on the terminal how far the dressing of a scene's garments is.
#pragma once

#include "sim/garment/dressing.h"

namespace icloth {

/// A watch that shows a line with the step and the time left, and erases it when it is gone.
DressingWatch show_dressing(bool quiet);

}  // namespace icloth
