// What `icloth bench paper` has measured so far, in a file that outlives an interruption.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace icloth {

/// 16 hex digits.
std::string hash_text(std::uint64_t hash);
/// The sum of some bytes, in the same form: FNV-1a, 64 bits.
std::string sum_text(std::string_view bytes);

/// Finished measurements by their names, in FOLDER/progress.json. Each has a key that names all on
/// which its result depends; one of another key, or one that is damaged, counts as not there.
class PaperStore {
 public:
  using Json = nlohmann::ordered_json;

  /// Begins anew, or with what the folder holds when the run goes on. An empty folder: nothing is
  /// written.
  PaperStore(std::string folder, bool go_on);

  /// The result, or null where it has to be measured.
  const Json* find(const std::string& name, const std::string& key);
  /// Keeps a result and writes the file.
  const Json& put(const std::string& name, const std::string& key, Json result);

  /// A file beside it for a state; empty where nothing is written.
  std::string checkpoint_path(const std::string& name) const;
  /// A line for the report and the terminal about what could not be used again.
  void note(std::string line);
  const std::vector<std::string>& notes() const { return notes_; }
  /// How many measurements were taken from the file.
  int reused() const { return reused_; }

 private:
  struct Entry {
    std::string key;
    Json result;
    bool counted = false;  ///< in reused_
    bool fresh = false;    ///< measured by this run
  };

  void load();
  void save() const;

  std::string folder_;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> notes_;
  int reused_ = 0;
  bool other_keys_ = false;  ///< a note about results of other keys was made
};

}  // namespace icloth
