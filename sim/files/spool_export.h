// Other formats from the spool of a run.
#pragma once

#include <string>

#include "sim/files/frame_export.h"
#include "sim/files/spool.h"

namespace icloth {

/// Writes all frames of a spool into a folder, with the bytes that the run itself gives the format:
/// frame_00000.obj and so on (or .ply), NAME.pc2 with NAME.obj, NAME.mdd, or scene.usda. Returns
/// what was written, as a message may say it. Throws InputError where a file cannot be written.
std::string export_spool(const Spool& spool, const std::string& folder, FrameFormat format);

}  // namespace icloth
