// The scenes that the window offers.
#pragma once

#include <string>
#include <vector>

namespace icloth {

/// Names of the built-in scenes: the dressed figure first, then the others by name.
std::vector<std::string> suggested_scenes();

}  // namespace icloth
