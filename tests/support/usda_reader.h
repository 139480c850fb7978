// A strict reader of the part of USDA that this program writes: anything else is an error.
#pragma once

#include <charconv>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace icloth::testing {

/// A mesh of a stage: lists by the name of their attribute, as plain numbers in the order of the
/// file; of those with time samples one list for each time code.
struct UsdaMesh {
  std::map<std::string, std::vector<double>> values;
  std::map<std::string, std::map<double, std::vector<double>>> samples;
};

struct UsdaStage {
  std::map<std::string, std::string> metadata;  ///< as they stand, strings with their quotes
  std::map<std::string, UsdaMesh> meshes;
};

class UsdaReader {
 public:
  explicit UsdaReader(std::string_view text) : rest_(text) {}

  UsdaStage read() {
    expect("#usda 1.0");
    expect("(");
    while (!take(")")) {
      const std::string key = word();
      expect("=");
      stage_.metadata[key] = value_word();
    }
    expect("def");
    expect("Xform");
    if (quoted() != "\"icloth\"") fail("another root");
    expect("{");
    while (take("def")) read_mesh();
    expect("}");
    blanks();
    if (!rest_.empty()) fail("something behind the end");
    return stage_;
  }

 private:
  void read_mesh() {
    expect("Mesh");
    const auto [entry, is_new] = stage_.meshes.try_emplace(quoted());
    if (!is_new) fail("two meshes of one name");
    expect("{");
    while (!take("}")) read_attribute(entry->second);
  }

  void read_attribute(UsdaMesh& mesh) {
    const bool uniform = take("uniform");
    const std::string type = word();
    std::string name = word();
    if (uniform) {
      expect("=");
      value_word();
      return;
    }
    const std::size_t width = type == "int[]"          ? 1
                              : type == "texCoord2f[]" ? 2
                              : type == "point3f[]" || type == "normal3f[]" || type == "float3[]"
                                  ? 3
                                  : 0;
    if (width == 0) fail("type " + type);
    expect("=");
    if (!name.ends_with(".timeSamples")) {
      mesh.values[name] = list(width);
      if (take("(")) {
        expect("interpolation");
        expect("=");
        quoted();
        expect(")");
      }
      return;
    }
    name.resize(name.size() - std::string(".timeSamples").size());
    expect("{");
    while (!take("}")) {
      const double time = number();
      expect(":");
      if (!mesh.samples[name].emplace(time, list(width)).second) fail("two samples of one time");
      expect(",");
    }
  }

  std::vector<double> list(std::size_t width) {
    std::vector<double> numbers;
    expect("[");
    for (bool first = true; !take("]"); first = false) {
      if (!first) expect(",");
      if (width > 1) expect("(");
      for (std::size_t k = 0; k < width; ++k) {
        if (k > 0) expect(",");
        numbers.push_back(number());
      }
      if (width > 1) expect(")");
    }
    return numbers;
  }

  double number() {
    blanks();
    double value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{}) fail("a number");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  std::string quoted() {
    blanks();
    const std::size_t end = rest_.find('"', 1);
    if (rest_.empty() || rest_[0] != '"' || end == std::string_view::npos) fail("a string");
    return cut(end + 1);
  }

  std::string word() {
    blanks();
    return cut(std::min(rest_.find_first_of(" \n="), rest_.size()));
  }

  std::string value_word() {
    blanks();
    return rest_.starts_with('"') ? quoted() : word();
  }

  std::string cut(std::size_t length) {
    if (length == 0) fail("a word");
    const std::string text(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return text;
  }

  bool take(std::string_view text) {
    blanks();
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  void expect(std::string_view text) {
    if (!take(text)) fail(std::string(text));
  }
  void blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size())); }
  [[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("usda: expected " + what + " before '" +
                             std::string(rest_.substr(0, 40)) + "'");
  }

  std::string_view rest_;
  UsdaStage stage_;
};

}  // namespace icloth::testing
