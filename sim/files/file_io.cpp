#include "sim/files/file_io.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw InputError(shown_path(path) + ": " + what + " (" + std::strerror(errno) + ")");
}

}  // namespace

std::uint64_t regular_file_size(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(shown_path(path) + ": no such file");
  if (!std::filesystem::is_regular_file(status))
    throw InputError(shown_path(path) + ": is a folder or a device, expected a file");
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(shown_path(path) + ": cannot be read (" + error.message() + ")");
  return size;
}

std::string read_file(const std::string& path, std::uint64_t max_bytes) {
  const std::uint64_t size = regular_file_size(path);
  if (size > max_bytes)
    throw InputError(shown_path(path) + ": " + std::to_string(size) + " bytes, expected at most " +
                     std::to_string(max_bytes));
  return read_head(path, size);
}

void require_folder(const std::string& option, const std::string& path) {
  const std::filesystem::path file(path);
  if (file.has_parent_path() && !std::filesystem::is_directory(file.parent_path()))
    throw InputError(option + " " + shown_path(path) + ": there is no folder " +
                     in_quotes(file.parent_path().string()));
}

std::string read_head(const std::string& path, std::size_t bytes) {
  regular_file_size(path);
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, "cannot be opened");

  // The file may be shorter, also than it was when its size was asked for.
  std::string contents(bytes, '\0');
  contents.resize(std::fread(contents.data(), 1, contents.size(), file.get()));
  if (std::ferror(file.get())) fail(path, "cannot be read");
  return contents;
}

bool lies_below(const std::string& path, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error, no_folder;
  const fs::path place = fs::weakly_canonical(path, error);
  const fs::path root = fs::weakly_canonical(fs::path(folder) / ".", no_folder);
  if (error || no_folder || path.find('\0') != std::string::npos) return false;
  const fs::path below = place.lexically_relative(root);
  return !below.empty() && *below.begin() != "..";
}

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), target_(path_) {
  std::error_code error;
  if (std::filesystem::is_symlink(path_, error))
    target_ = std::filesystem::weakly_canonical(path_, error).string();
  if (error) target_ = path_;
  const auto status = std::filesystem::status(target_, error);
  const bool is_device = std::filesystem::exists(status) &&
                         !std::filesystem::is_regular_file(status) &&
                         !std::filesystem::is_directory(status);
  // The process number keeps two programs that write the same file apart.
  if (!is_device) temporary_ = target_ + ".tmp" + std::to_string(::getpid());
  file_ = std::fopen(is_device ? target_.c_str() : temporary_.c_str(), "wb");
  if (!file_) icloth::fail(path_, "cannot be written");
}

OutputFile::~OutputFile() {
  if (!file_) return;
  std::fclose(file_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void OutputFile::fail() {
  const int reason = errno;
  if (file_) std::fclose(file_);
  file_ = nullptr;
  if (!temporary_.empty()) std::remove(temporary_.c_str());
  errno = reason;
  icloth::fail(path_, "cannot be written");
}

void OutputFile::write(std::string_view contents) {
  if (std::fwrite(contents.data(), 1, contents.size(), file_) != contents.size()) fail();
}

void OutputFile::commit() {
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!closed) fail();
  if (!temporary_.empty() && std::rename(temporary_.c_str(), target_.c_str()) != 0) fail();
}

void write_file(const std::string& path, std::string_view contents) {
  OutputFile file(path);
  file.write(contents);
  file.commit();
}

void append_file(const std::string& path, std::string_view contents) {
  // The present size says how much to cut off after an error. Devices such as a terminal have none.
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const bool is_regular = !error;
  File file(std::fopen(path.c_str(), "ab"));
  if (!file) fail(path, "cannot be written");
  const bool written =
      std::fwrite(contents.data(), 1, contents.size(), file.get()) == contents.size();
  const bool closed = std::fclose(file.release()) == 0;
  if (written && closed) return;

  // A part that was written is cut off again; the message must give the reason of the first error.
  const int reason = errno;
  if (is_regular) std::filesystem::resize_file(path, size, error);
  errno = reason;
  fail(path, "cannot be written");
}

}  // namespace icloth
