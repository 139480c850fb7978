// Whole files in and out, with the errors that users see.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace icloth {

/// Size of a regular file [bytes]. Throws InputError when it is missing or no regular file.
std::uint64_t regular_file_size(const std::string& path);

/// Contents of a regular file. Throws InputError when it is missing, no regular file, unreadable or
/// larger than `max_bytes`.
std::string read_file(const std::string& path, std::uint64_t max_bytes = std::uint64_t{1} << 34);

/// The first bytes of a file, fewer where it is shorter. Throws InputError as read_file does.
std::string read_head(const std::string& path, std::size_t bytes);

/// Throws InputError where a file that `option` names would lie in a folder that there is not.
void require_folder(const std::string& option, const std::string& path);

/// Whether a path lies in a folder or below it, after all links of both have been followed; empty
/// is the current folder. False where links go round, and for a path with a zero byte, at which the
/// system would end it. Nothing is opened.
bool lies_below(const std::string& path, const std::string& folder);

/// Extension with its dot, in lower case: ".obj"; empty where there is none.
std::string lower_extension(const std::string& path);

/// A file that appears whole or not at all: it is written to a temporary beside `path` and renamed
/// by commit(). A link is followed; a device, for example /dev/stdout, is written directly. All
/// throw InputError when the place cannot be written, for example because the disk is full.
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view contents);
  void commit();

 private:
  [[noreturn]] void fail();

  std::string path_;       ///< as asked for, for messages
  std::string target_;     ///< where links lead to
  std::string temporary_;  ///< empty for a device
  std::FILE* file_ = nullptr;
};

/// Writes a whole file through OutputFile.
void write_file(const std::string& path, std::string_view contents);

/// Adds to the end of a file, all or nothing. Throws InputError as OutputFile does.
void append_file(const std::string& path, std::string_view contents);

}  // namespace icloth
