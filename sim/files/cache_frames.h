// The frames of a PC2 file, one after the other.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {

inline constexpr std::size_t kPc2HeadBytes = 32;

/// Reads frames of a cache that this program wrote itself, in little memory.
class CacheFrames {
 public:
  /// Throws InputError where the file cannot be read.
  explicit CacheFrames(std::string path)
      : path_(std::move(path)), file_(std::fopen(path_.c_str(), "rb"), std::fclose) {
    if (!file_ || std::fseek(file_.get(), kPc2HeadBytes, SEEK_SET) != 0)
      throw InputError(shown_path(path_) + ": cannot be read");
  }

  /// Fills the list, whose length is kept, with the next frame.
  template <class Number>
  void next(std::vector<Number>& frame) {
    if (std::fread(frame.data(), sizeof(Number), frame.size(), file_.get()) != frame.size())
      throw InputError(shown_path(path_) + ": ends before its last frame");
  }

 private:
  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace icloth
