#include "app/suites/bench/compare.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "app/suites/bench/child_program.h"
#include "app/suites/bench/paper_run.h"
#include "app/suites/bench/suite.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

/// Columns of the statistics whose ratios are shown, and their names in the table.
constexpr std::pair<const char*, const char*> kStages[] = {{"ms_total", "whole step"},
                                                           {"ms_implicit", "implicit"},
                                                           {"ms_broad_phase", "broad phase"},
                                                           {"ms_proximity", "proximity"},
                                                           {"ms_ccd", "CCD"},
                                                           {"ms_impact_zones", "impact zones"}};

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

/// A folder for files of the runs, which is removed at the end.
class WorkFolder {
 public:
  WorkFolder() : path_(fs::temp_directory_path() / ("icloth-compare-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// One of the two programs.
struct Program {
  std::string path;
  std::string label;  ///< in names of files
};

/// The program that lies beside this one.
Program this_program() {
  std::error_code error;
  return {(fs::read_symlink("/proc/self/exe", error).parent_path() / "icloth").string(), "this"};
}

/// Runs both programs over the stretches of one scene.
class Comparison {
 public:
  Comparison(const BenchOptions& options, const PaperScene& scene, const Stretch& stretch,
             const WorkFolder& folder)
      : options_(options), scene_(scene), stretch_(stretch), folder_(folder) {}

  /// A program makes its own state at the beginning of the stretch, as another version may not read
  /// it. Throws std::runtime_error where the program fails.
  void begin(const Program& program) const {
    std::vector<std::string> words = command(program, stretch_.first);
    words.insert(words.end(), {"--checkpoint", checkpoint(program), "--checkpoint-every",
                               std::to_string(stretch_.first)});
    run(program, words);
  }

  /// Makes the steps of the stretch.
  StretchStatistics measure(const Program& program) const {
    const std::string csv = folder_.file(program.label + ".csv");
    std::error_code ignored;
    fs::remove(csv, ignored);
    std::vector<std::string> words = command(program, stretch_.end());
    words.insert(words.end(), {"--resume", checkpoint(program), "--stats", csv});
    run(program, words);
    return read_stretch(read_file(csv), csv, stretch_.first);
  }

 private:
  std::string checkpoint(const Program& program) const {
    return folder_.file(program.label + ".checkpoint");
  }

  std::vector<std::string> command(const Program& program, long steps) const {
    std::vector<std::string> words = {program.path, "run",     std::string(scene_.name),
                                      "--quiet",    "--steps", std::to_string(steps)};
    for (const std::string& change : overrides_of(options_.scale, scene_, stretch_))
      words.insert(words.end(), {"--set", change});
    words.insert(words.end(), {"--device", options_.device.empty() ? "cpu" : options_.device});
    if (options_.threads > 0)
      words.insert(words.end(), {"--threads", std::to_string(options_.threads)});
    return words;
  }

  void run(const Program& program, const std::vector<std::string>& words) const {
    const std::string log = folder_.file(program.label + ".log");
    const int code = run_child(words, log);
    if (code == 0) return;
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    throw std::runtime_error("bench compare: '" + text + "' ended with " + std::to_string(code) +
                             ": " + one_line(read_file(log)));
  }

  const BenchOptions& options_;
  const PaperScene& scene_;
  const Stretch& stretch_;
  const WorkFolder& folder_;
};

/// Both programs on one stretch, as rows of the tables.
void compare_stretch(const BenchOptions& options, const PaperScene& scene, const Stretch& stretch,
                     Table& speed, Table& stages) {
  const WorkFolder folder;
  const Comparison comparison(options, scene, stretch, folder);
  const Program ours = this_program(), other{options.other, "other"};
  comparison.begin(ours);
  comparison.begin(other);

  // Who begins changes from turn to turn, so that a drift of the machine helps neither.
  std::vector<double> our_ms, other_ms;
  std::map<std::string, std::vector<double>> ratios;
  bool same_end = true;
  for (int turn = 0; turn < options.repeat; ++turn) {
    StretchStatistics a, b;
    const bool we_begin = turn % 2 == 0;
    if (we_begin) a = comparison.measure(ours);
    b = comparison.measure(other);
    if (!we_begin) a = comparison.measure(ours);
    same_end = same_end && a.end_hash == b.end_hash;
    our_ms.push_back(a.sum("ms_total") / static_cast<double>(stretch.steps));
    other_ms.push_back(b.sum("ms_total") / static_cast<double>(stretch.steps));
    for (const auto& [column, name] : kStages)
      if (a.sum(column) > 0) ratios[column].push_back(b.sum(column) / a.sum(column));
  }

  const std::string title(scene.title);
  const Spread whole = spread_of(ratios["ms_total"]);
  speed.add({title, stretch_text(stretch), format_number(spread_of(our_ms).median),
             format_number(spread_of(other_ms).median), format_number(whole.median, 3),
             format_number(whole.least, 3), format_number(whole.most, 3), same_end ? "yes" : "no"});
  std::vector<std::string> cells = {title, stretch_text(stretch)};
  for (const auto& [column, name] : kStages)
    cells.push_back(ratios[column].empty() ? "–"
                                           : format_number(spread_of(ratios[column]).median, 3));
  stages.add(std::move(cells));
}

}  // namespace

double StretchStatistics::sum(const std::string& column) const {
  const auto found = values.find(column);
  return found == values.end() ? 0
                               : std::accumulate(found->second.begin(), found->second.end(), 0.0);
}

StretchStatistics read_stretch(const std::string& csv, const std::string& source, long first) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> columns = fields_of(line);
  if (columns.empty() || columns[0] != "step")
    throw InputError(shown_path(source) + ": line 1: expected the columns of statistics");

  // Texts such as the hash are kept apart from numbers; the last row has the end.
  StretchStatistics statistics;
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() > columns.size() || fields.empty())
      throw InputError(shown_path(source) + ": line " + std::to_string(number) + ": " +
                       std::to_string(fields.size()) + " fields, expected " +
                       std::to_string(columns.size()));
    double step = -1;
    std::from_chars(fields[0].data(), fields[0].data() + fields[0].size(), step);
    if (step < static_cast<double>(first)) continue;
    for (std::size_t c = 0; c < fields.size(); ++c) {
      double value = 0;
      const char* end = fields[c].data() + fields[c].size();
      if (columns[c] == "state_hash")
        statistics.end_hash = fields[c];
      else if (std::from_chars(fields[c].data(), end, value).ptr == end)
        statistics.values[columns[c]].push_back(value);
    }
  }
  if (statistics.values["ms_total"].empty())
    throw InputError(shown_path(source) + ": no row from step " + std::to_string(first) + " on");
  return statistics;
}

Spread spread_of(std::vector<double> ratios) {
  if (ratios.empty()) return {};
  std::ranges::sort(ratios);
  const std::size_t middle = ratios.size() / 2;
  const double median =
      ratios.size() % 2 == 1 ? ratios[middle] : 0.5 * (ratios[middle - 1] + ratios[middle]);
  return {median, ratios.front(), ratios.back()};
}

int run_compare(const BenchOptions& options) {
  if (access(options.other.c_str(), X_OK) != 0 || fs::is_directory(options.other))
    throw InputError(
        "bench compare: " + (options.other.empty() ? "no program" : shown_path(options.other)) +
        ", expected the path of another icloth program");
  Report report = begin_report(options, only_build(options));
  report.text("This program and " + shown_path(options.other) + " made the same steps in turns, " +
              std::to_string(options.repeat) +
              " times each. A ratio is how many times as long the other one takes; spread is that "
              "of the turns.");

  Table speed("compare", "Milliseconds a step",
              {"benchmark", "steps", "this", "other", "other / this", "least", "most", "same end"});
  std::vector<std::string> columns = {"benchmark", "steps"};
  for (const auto& [column, name] : kStages) columns.push_back(name);
  Table stages("compare_stages", "Ratios of the stages, other / this", columns);

  // Cases are scenes; without one all of them are compared.
  bool any = false;
  for (const PaperScene& scene : scenes_at(options.scale)) {
    if (!chosen(options, scene.name)) continue;
    any = true;
    for (const Stretch& stretch : scene.stretches) {
      if (!options.quiet)
        std::fprintf(stderr, "icloth: %s %s\n", std::string(scene.title).c_str(),
                     stretch_text(stretch).c_str());
      compare_stretch(options, scene, stretch, speed, stages);
    }
  }
  if (!any) throw no_such_case(options);
  report.add(speed);
  report.add(stages);
  finish_report(options, report);
  return 0;
}

}  // namespace icloth
