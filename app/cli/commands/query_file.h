// Files of elementary collision queries, read as a stream.
//
// The files are CSV, plain or gzip (where zlib was there at build time). The columns are the kind,
// `vf` or `ee`; 24 numbers, decimal or C99 hexadecimal, which are x y z of four points at t = 0 and
// then at t = 1 (vf: vertex, face v0 v1 v2; ee: a0 a1 b0 b1); and optionally the expected result, 0
// or 1. Further columns are not read. The first line may be a header; empty lines are passed over.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "kernels/ccd/elementary_ccd.h"

namespace icloth {

struct FileQuery {
  PairKind kind{};
  CcdQuery<double> query;
  int expected = -1;  ///< 0, 1, or -1 when the file does not say
};

/// Reads queries from a file, one after the other.
class QueryFile {
 public:
  /// Opens the file. Throws InputError when it cannot be opened or is gzip and this build has no
  /// zlib.
  explicit QueryFile(const std::string& path);
  ~QueryFile();

  /// Reads the next query; false at the end. Throws InputError naming line, column and value.
  bool next(FileQuery& out);

 private:
  struct Bytes;  // the open file

  bool next_line(std::string_view& line);
  bool fill();
  [[noreturn]] void refuse(const std::string& what) const;
  double number(std::string_view field, int column) const;

  std::string path_;
  std::unique_ptr<Bytes> bytes_;
  std::string buffer_;
  std::size_t begin_ = 0;  // of the part of buffer_ that was not read yet
  long line_number_ = 0;
};

}  // namespace icloth
