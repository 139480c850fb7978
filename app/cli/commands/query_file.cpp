#include "app/cli/commands/query_file.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "sim/files/error.h"
#include "sim/files/text.h"

#if defined(ICLOTH_HAS_ZLIB)
#include <zlib.h>
#endif

namespace icloth {
namespace {

constexpr std::size_t kChunk = 1 << 18;    // bytes read at a time
constexpr std::size_t kMaxLine = 1 << 16;  // longer lines are refused

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
    s.remove_suffix(1);
  return s;
}

/// Takes the next comma-separated field off the line.
std::string_view take_field(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view field = line.substr(0, comma);
  line = comma == std::string_view::npos ? std::string_view{} : line.substr(comma + 1);
  return trimmed(field);
}

/// The content of column 0 … 23 in the user's words.
std::string column_name(int column) {
  const std::string axis(1, "xyz"[column % 3]);
  return axis + " of point " + std::to_string(column / 3 % 4) +
         " at t=" + (column < 12 ? "0" : "1");
}

}  // namespace

#if defined(ICLOTH_HAS_ZLIB)
// The bytes of a file, which zlib passes on unchanged where the file is plain.
struct QueryFile::Bytes {
  gzFile file;
  explicit Bytes(const std::string& path) : file(gzopen(path.c_str(), "rb")) {}
  ~Bytes() {
    if (file) gzclose_r(file);
  }
  long read(char* out, std::size_t size) const {
    const int count = gzread(file, out, static_cast<unsigned>(size));
    int status = Z_OK;

    // A file that was cut off is only reported here.
    gzerror(file, &status);
    return status < 0 ? -1 : count;
  }
};
#else
struct QueryFile::Bytes {
  std::FILE* file;
  explicit Bytes(const std::string& path) : file(std::fopen(path.c_str(), "rb")) {}
  ~Bytes() {
    if (file) std::fclose(file);
  }
  long read(char* out, std::size_t size) const {
    const std::size_t count = std::fread(out, 1, size, file);
    return std::ferror(file) ? -1 : static_cast<long>(count);
  }
};
#endif

QueryFile::QueryFile(const std::string& path) : path_(path) {
#if !defined(ICLOTH_HAS_ZLIB)
  if (path.ends_with(".gz")) {
    throw InputError(shown_path(path) +
                     ": compressed query files need a build with zlib (package zlib1g-dev); "
                     "expected a plain .csv");
  }
#endif
  bytes_ = std::make_unique<Bytes>(path);
  if (!bytes_->file)
    throw InputError(shown_path(path) + ": cannot be opened; expected a CSV file of queries");
}

QueryFile::~QueryFile() = default;

/// Throws InputError with the place in the file.
void QueryFile::refuse(const std::string& what) const {
  throw InputError(shown_path(path_) + ":" + std::to_string(line_number_) + ": " + what);
}

/// Reads another chunk behind the part that was not used yet. False at the end of the file.
bool QueryFile::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + kChunk);
  const long count = bytes_->read(buffer_.data() + kept, kChunk);
  if (count < 0) {
    throw InputError(shown_path(path_) + ": cannot be read after line " +
                     std::to_string(line_number_) + "; the file is damaged or cut off");
  }
  buffer_.resize(kept + static_cast<std::size_t>(count));
  return count > 0;
}

bool QueryFile::next_line(std::string_view& line) {
  // The search goes on where it ended before the last chunk came, so that every byte is seen once.
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = buffer_.find('\n', begin_ + searched);
    if (end != std::string::npos) {
      line = std::string_view(buffer_).substr(begin_, end - begin_);
      begin_ = end + 1;
      break;
    }

    // The last line may have no end, and a line must not fill the memory.
    searched = buffer_.size() - begin_;
    if (searched > kMaxLine || !fill()) {
      line = std::string_view(buffer_).substr(begin_);
      begin_ = buffer_.size();
      if (line.empty()) return false;
      break;
    }
  }

  ++line_number_;
  if (line.size() > kMaxLine) refuse("line of more than 65536 characters; expected one query");
  return true;
}

double QueryFile::number(std::string_view field, int column) const {
  // std::from_chars knows no plus sign and no 0x, so both are taken off first.
  std::string_view digits = field;
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.remove_prefix(1);
  const bool hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
  if (hexadecimal) digits.remove_prefix(2);

  double value = 0;
  const char* end = digits.data() + digits.size();
  const auto result = std::from_chars(
      digits.data(), end, value, hexadecimal ? std::chars_format::hex : std::chars_format::general);

  // The whole field has to be one finite number, with one sign at most.
  const bool doubled_sign = digits.starts_with('-');
  if (result.ec != std::errc{} || result.ptr != end || doubled_sign || !std::isfinite(value)) {
    refuse(column_name(column) + " is " + in_quotes(field) + ", expected a finite number");
  }
  return negative ? -value : value;
}

bool QueryFile::next(FileQuery& out) {
  // Empty lines, and a header in the first line, are passed over.
  std::string_view line;
  bool is_query = false;
  while (!is_query) {
    if (!next_line(line)) return false;
    const bool header = line_number_ == 1 && !line.starts_with("vf") && !line.starts_with("ee");
    is_query = !header && !trimmed(line).empty();
  }

  const std::string_view kind = take_field(line);
  if (kind != "vf" && kind != "ee") refuse("kind is " + in_quotes(kind) + ", expected vf or ee");
  out.kind = kind == "vf" ? PairKind::vf : PairKind::ee;

  // The 24 coordinates stand in the order point by point, first at t = 0 and then at t = 1.
  for (int i = 0; i < 24; ++i) {
    if (line.empty()) refuse(column_name(i) + " is missing, expected 24 numbers after the kind");
    const double value = number(take_field(line), i);
    Vec3d& point = i < 12 ? out.query.p0[i / 3] : out.query.p1[i / 3 - 4];
    (i % 3 == 0 ? point.x : i % 3 == 1 ? point.y : point.z) = value;
  }

  // The expected result is optional.
  const std::string_view expected = take_field(line);
  if (expected != "" && expected != "0" && expected != "1") {
    refuse("expected result is " + in_quotes(expected) + ", expected 0 or 1");
  }
  out.expected = expected.empty() ? -1 : expected == "1";
  return true;
}

}  // namespace icloth
