// Whole files in and out, with the errors that users see.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace icloth {

/// Contents of a regular file. Throws InputError when it is missing, no regular file, unreadable or
/// larger than `max_bytes`.
std::string read_file(const std::string& path, std::uint64_t max_bytes = std::uint64_t{1} << 34);

/// Extension with its dot, in lower case: ".obj"; empty where there is none.
std::string lower_extension(const std::string& path);

/// Written to a temporary beside `path` first, then renamed: readers never see half a file.
/// Throws InputError when the place cannot be written.
void write_file(const std::string& path, std::string_view contents);

}  // namespace icloth
