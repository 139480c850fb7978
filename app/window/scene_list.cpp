#include "app/window/scene_list.h"

#include <algorithm>
#include <sstream>

#include "sim/files/assets.h"

namespace icloth {

std::vector<std::string> suggested_scenes() {
  std::istringstream words(asset_names("scenes"));
  std::vector<std::string> names;
  for (std::string name; words >> name;) names.push_back(name);
  std::stable_partition(names.begin(), names.end(),
                        [](const std::string& name) { return name == "dressed"; });
  return names;
}

}  // namespace icloth
