#include "app/suites/bench/paper_store.h"

#include <cinttypes>
#include <cstdio>
#include <filesystem>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr int kFormat = 1;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;

/// The sum of an entry, by which damage is noticed.
std::string sum_of(const std::string& name, const std::string& key,
                   const PaperStore::Json& result) {
  return sum_text(name + '\n' + key + '\n' + result.dump());
}

}  // namespace

std::string hash_text(std::uint64_t hash) {
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

std::string sum_text(std::string_view bytes) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash_text(sum);
}

PaperStore::PaperStore(std::string folder, bool go_on) : folder_(std::move(folder)) {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_ + "/checkpoints", error);
  if (error) throw InputError("--out " + folder_ + ": " + error.message());
  if (go_on) {
    load();
    return;
  }

  // Hours of measurements are not thrown away because an option was forgotten.
  const std::string path = folder_ + "/progress.json";
  if (!std::filesystem::exists(path, error)) return;
  std::filesystem::rename(path, folder_ + "/progress.old.json", error);
  note(path +
       " of an earlier run is now progress.old.json (--continue would have gone on with it)");
}

void PaperStore::note(std::string line) {
  std::fprintf(stderr, "icloth: note: %s\n", one_line(line).c_str());
  notes_.push_back(std::move(line));
}

void PaperStore::load() {
  const std::string path = folder_ + "/progress.json";
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    return note(path + " is not there: everything is measured");

  // The file may be cut off or be another one altogether.
  Json file;
  try {
    file = Json::parse(read_file(path, kMostBytes), nullptr, false);
  } catch (const InputError& failure) {
    return note(std::string(failure.what()) + ": everything is measured anew");
  }
  if (!file.is_object() || file.value("format", Json()) != kFormat ||
      !file.value("measurements", Json()).is_object())
    return note(path + " is damaged or of another version: everything is measured anew");

  // Every entry has a sum of its own, so that damage to one costs that one alone.
  for (const auto& [name, item] : file["measurements"].items()) {
    const bool whole = item.is_object() && item.contains("key") && item["key"].is_string() &&
                       item.contains("result") && item.contains("sum") &&
                       item["sum"] == sum_of(name, item["key"], item["result"]);
    if (whole)
      entries_[name] = {item["key"], item["result"]};
    else
      note(path + ": " + in_quotes(name) + " is damaged and is measured anew");
  }
}

const PaperStore::Json* PaperStore::find(const std::string& name, const std::string& key) {
  const auto found = entries_.find(name);
  if (found == entries_.end()) return nullptr;
  Entry& entry = found->second;

  // What another program, device or scene has given says nothing about this one. One note stands
  // for all of them.
  if (entry.key != key) {
    if (!other_keys_)
      note(name + " and maybe others were measured with another program, device, scene or scale: " +
           "they are measured anew");
    other_keys_ = true;
    entries_.erase(found);
    return nullptr;
  }
  if (!entry.fresh && !entry.counted) ++reused_;
  entry.counted = true;
  return &entry.result;
}

const PaperStore::Json& PaperStore::put(const std::string& name, const std::string& key,
                                        Json result) {
  Entry& entry = entries_[name] = {key, std::move(result), false, true};
  save();
  return entry.result;
}

void PaperStore::save() const {
  if (folder_.empty()) return;
  Json file = {{"format", kFormat}, {"measurements", Json::object()}};
  for (const auto& [name, entry] : entries_)
    file["measurements"][name] = {{"key", entry.key},
                                  {"sum", sum_of(name, entry.key, entry.result)},
                                  {"result", entry.result}};
  write_file(folder_ + "/progress.json", file.dump() + "\n");
}

std::string PaperStore::checkpoint_path(const std::string& name) const {
  return folder_.empty() ? "" : folder_ + "/checkpoints/" + name + ".checkpoint";
}

}  // namespace icloth
