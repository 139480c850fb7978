// Small patterns for the tests.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/pattern/pattern.h"

namespace icloth {

/// Corners and edges of a rectangle with its lower left corner at the origin, in centimetres.
/// Edges: 0 below, 1 right, 2 above, 3 left. `more`: further keys of the panel.
inline std::string rectangle(const std::string& name, double width, double height,
                             const std::string& more = "") {
  const std::string w = std::to_string(width), h = std::to_string(height);
  return '"' + name + R"(": {"vertices": [[0, 0], [)" + w + ", 0], [" + w + ", " + h + "], [0, " +
         h + R"(]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, )" +
         R"({"endpoints": [2, 3]}, {"endpoints": [3, 0]}])" + (more.empty() ? "" : ", " + more) +
         "}";
}

/// A file of panels and stitches, each in JSON.
inline std::string pattern_file(const std::string& panels, const std::string& stitches = "",
                                const std::string& properties = R"("units_in_meter": 100)") {
  return R"({"pattern": {"panels": {)" + panels + R"(}, "stitches": [)" + stitches +
         R"(]}, "properties": {)" + properties + "}}";
}

inline std::string stitch(const std::string& a, int edge_a, const std::string& b, int edge_b,
                          const std::string& third = "") {
  return R"([{"panel": ")" + a + R"(", "edge": )" + std::to_string(edge_a) + R"(}, {"panel": ")" +
         b + R"(", "edge": )" + std::to_string(edge_b) + "}" +
         (third.empty() ? "" : ", \"" + third + "\"") + "]";
}

inline Pattern parsed(const std::string& text) { return parse_pattern(text, "test.json"); }

/// The front of a T-shirt: straight, quadratic and cubic edges, 50 cm wide and 62 cm long.
inline std::string shirt_front() {
  return R"("front": {"vertices": [[-25, -62], [25, -62], [24.5, -22], [20, -3.5], [8.5, 0],
    [-8.5, 0], [-20, -3.5], [-24.5, -22]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
    {"endpoints": [2, 3], "curvature": {"type": "quadratic", "params": [[0.30, 0.24]]}},
    {"endpoints": [3, 4]},
    {"endpoints": [4, 5], "curvature": {"type": "cubic", "params": [[0.1, 0.62], [0.9, 0.62]]}},
    {"endpoints": [5, 6]},
    {"endpoints": [6, 7], "curvature": {"type": "quadratic", "params": [[0.70, 0.24]]}},
    {"endpoints": [7, 0]}]})";
}

/// A disc of two half circles.
inline std::string disc(const std::string& name, double radius) {
  const std::string r = std::to_string(radius);
  const std::string curve = R"("curvature": {"type": "circle", "params": [)" + r + ", 0, 1]}";
  return '"' + name + R"(": {"vertices": [[-)" + r + ", 0], [" + r +
         R"(, 0]], "edges": [{"endpoints": [0, 1], )" + curve + R"(}, {"endpoints": [1, 0], )" +
         curve + "}]}";
}

/// Patterns of the data folder, which is not part of the sources; empty where it is missing.
inline std::vector<std::string> data_patterns() {
  const char* set = std::getenv("ICLOTH_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(set ? set : ICLOTH_DATA_DEFAULT) / "patterns";
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

}  // namespace icloth
