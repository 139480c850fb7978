// Places of the files that come with the program.
#pragma once

#include <string>

namespace icloth {

/// Folder with scenes/ materials/ bodies/ … : $ICLOTH_ASSETS, beside the program, or the source
/// tree.
std::string assets_folder();

/// Path of a file named in a scene: absolute, else below `folder` (the scene's), else below
/// assets_folder(). The first place that has it; the first candidate when none has.
std::string find_asset(const std::string& name, const std::string& folder);

/// Names of assets/KIND/*.json, sorted, each after a space: " a b c".
std::string asset_names(const std::string& kind);

}  // namespace icloth
