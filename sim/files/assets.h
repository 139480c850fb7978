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

/// The files that a scene may make this program open: those below its own folder and those below
/// assets_folder(). A scene comes from anyone, and the other files of a user are none of its
/// business.
struct FileScope {
  std::string folder;     ///< of the scene; empty: the current one
  bool anywhere = false;  ///< every file may be opened (--allow-outside)
};

/// Throws InputError where the path leads out of the scope, after all links have been followed.
/// `name` is the path as the scene has it, and `where` its place there, for the message. Nothing is
/// opened.
void require_in_scope(const std::string& path, const std::string& name, const std::string& where,
                      const FileScope& scope);

/// Names of assets/KIND/*.json, sorted, each after a space: " a b c".
std::string asset_names(const std::string& kind);

}  // namespace icloth
