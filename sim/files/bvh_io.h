// Motions in BVH files: joints with offsets from each other, and their angles frame by frame.
#pragma once

#include <string>
#include <string_view>

#include "sim/bodies/rig.h"

namespace icloth {

/// The joints of a BVH file as the nodes of a rig without vertices, and its motion as its only
/// clip. The rest pose is that of the offsets, in which no joint is turned. Position channels
/// replace the offset of their joint; angles turn about the moved axes in the order of their
/// channels. The ends of the last joints (End Site) are nodes without a name that do not move.
///
/// `path`: for messages. Throws InputError naming line, value and what was expected; memory is
/// taken for no more than the text can hold.
Rig parse_bvh(std::string_view text, const std::string& path);

}  // namespace icloth
