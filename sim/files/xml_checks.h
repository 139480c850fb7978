// Checks of XML files that readers walk by recursion.
#pragma once

#include <string>
#include <string_view>

namespace icloth {

/// Refuses elements nested too deeply, and Collada nodes that contain themselves, by instances, or
/// are repeated more often than any scene needs. What is no XML passes: its reader refuses it.
/// Throws InputError naming file, element, value and what was expected.
void check_xml(std::string_view text, const std::string& path);

}  // namespace icloth
