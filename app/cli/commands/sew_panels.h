// icloth sew MESH --within D: the panels of a delivered garment, sewn where their borders meet.
#pragma once

#include "app/cli/commands/sew.h"

namespace icloth {

/// Proposes the seams of options.pattern, a mesh of panels at their places on a body, and writes
/// the garment: an OBJ with its seams welded, parted where it then intersects, its uv the rest
/// shape; or a .json scene that closes them as open seams. Returns 0, or 1 where faces of the
/// welded garment still intersect; they are named then, and no OBJ is written. Throws InputError.
int sew_panels(const SewOptions& options);

}  // namespace icloth
