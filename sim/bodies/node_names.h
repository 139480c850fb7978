// Which joint of a motion is which node of a body, by their names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/bodies/rig.h"

namespace icloth {

/// A joint of a motion and the node of a body that does what it does.
struct NodePair {
  Index joint, node;
};

/// A name without what programs put in front of it ("mixamorig:"), in lower case and without
/// blanks, dots, hyphens and underscores.
std::string plain_name(std::string_view name);

/// The part of a body that a name usually stands for, by one word for all its names and with its
/// side: "thigh.l" of "LeftUpLeg" and "thigh.L"; empty where the name is none of the known ones.
std::string part_name(std::string_view name);

/// The pairs in the order of the joints. Those that are `given` come first; then the nodes whose
/// plain names are the same, then those that stand for the same part of a body. A joint or node is
/// in one pair at most, the first one of a name where several have it.
std::vector<NodePair> pair_nodes(const std::vector<std::string>& joints,
                                 const std::vector<std::string>& nodes,
                                 const std::vector<NodePair>& given);

}  // namespace icloth
