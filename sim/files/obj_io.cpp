// Wavefront OBJ: v, vt, f, g and o, over several lines where they end in a backslash; everything
// else is skipped.
#include <charconv>
#include <cmath>
#include <filesystem>

#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/polygon.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

struct Corner {
  Index vertex = kNone, uv = kNone;
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  MeshFile parse() {
    // Some editors put a mark in front of UTF-8, which must not hide the first vertex.
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());

    while (!text_.empty()) {
      line_ = next_line_;
      parse_line(next_statement());
    }
    close_group();
    if (!all_have_uv_) file_.mesh.uv.clear();
    return std::move(file_);
  }

 private:
  [[noreturn]] void refuse(const std::string& element, std::string_view value,
                           const std::string& expected) const {
    throw InputError(path_ + ": line " + std::to_string(line_) + ": " + element + ": value " +
                     in_quotes(value) + ", expected " + expected);
  }

  std::string_view next_physical_line() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    const std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++next_line_;
    return line;
  }

  /// The next line without its comment, together with those that it goes on to: a backslash at the
  /// end of a line stands for a blank.
  std::string_view next_statement() {
    std::string_view line = next_physical_line();
    line = line.substr(0, line.find('#'));
    if (!take_backslash(line)) return line;

    // The pieces of a statement are copied into one text, with blanks in place of the line breaks.
    joined_ = line;
    for (bool goes_on = true; goes_on && !text_.empty();) {
      line = next_physical_line();
      line = line.substr(0, line.find('#'));
      goes_on = take_backslash(line);
      joined_ += ' ';
      joined_ += line;
    }
    return joined_;
  }

  /// Removes a backslash at the end of a line, which a carriage return may follow.
  static bool take_backslash(std::string_view& line) {
    std::string_view rest = line;
    if (rest.ends_with('\r')) rest.remove_suffix(1);
    if (!rest.ends_with('\\')) return false;
    rest.remove_suffix(1);
    line = rest;
    return true;
  }

  void parse_line(std::string_view line) {
    Words words(line);
    const std::string_view key = words.next();

    // Other statements, such as normals and materials, are passed over.
    if (key == "v") {
      parse_vertex(words);
    } else if (key == "vt") {
      parse_uv(words);
    } else if (key == "f") {
      parse_face(words);
    } else if (key == "g" || key == "o") {
      close_group();
      group_.name = std::string(words.next());
    }
  }

  double number(const std::string& element, std::string_view word, const char* expected) const {
    double value = 0;
    const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool valid = error == std::errc{} && rest == digits.data() + digits.size() &&
                       std::abs(value) <= kLargestCoordinate;
    if (!valid) refuse(element, word.empty() ? "(end of line)" : word, expected);
    return value;
  }

  void parse_vertex(Words& words) {
    const std::string element = "vertex " + std::to_string(file_.mesh.positions.size() + 1);
    Vec3d p;
    for (double* x : {&p.x, &p.y, &p.z})
      *x = number(element, words.next(), "three finite coordinates");
    if (file_.mesh.positions.size() >= kLargestCount)
      refuse(element, "one more", "at most 536870911 vertices");
    file_.mesh.positions.push_back(p);
  }

  void parse_uv(Words& words) {
    const std::string element = "vt " + std::to_string(uv_.size() + 1);
    Vec2d p;
    for (double* x : {&p.x, &p.y})
      *x = number(element, words.next(), "two finite material coordinates");
    uv_.push_back(p);
  }

  /// 1-based, or negative and counted back from the last one so far.
  Index index(const std::string& element, std::string_view word, std::size_t count,
              const char* kind) const {
    std::int64_t value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const auto limit = static_cast<std::int64_t>(count);
    const bool valid = error == std::errc{} && rest == word.data() + word.size() && value != 0 &&
                       value <= limit && value >= -limit;
    if (!valid)
      refuse(element, word.empty() ? "(nothing)" : word,
             std::string("the number of a ") + kind + " from 1 to " + std::to_string(count));
    return static_cast<Index>(value > 0 ? value - 1 : limit + value);
  }

  /// v, v/vt, v//vn or v/vt/vn.
  Corner corner(const std::string& element, std::string_view word) const {
    const std::size_t slash = word.find('/');
    Corner result;
    result.vertex = index(element, word.substr(0, slash), file_.mesh.positions.size(), "vertex");
    if (slash == std::string_view::npos) return result;
    const std::string_view rest = word.substr(slash + 1);
    const std::string_view uv = rest.substr(0, rest.find('/'));
    const bool skipped = uv.empty() && rest.size() > uv.size();
    if (!skipped) result.uv = index(element, uv, uv_.size(), "vt");
    return result;
  }

  void parse_face(Words& words) {
    const std::string element = "face " + std::to_string(++faces_);
    std::vector<Corner> corners;
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      corners.push_back(corner(element, word));
    if (corners.size() < 3)
      refuse(element, std::to_string(corners.size()) + " corners", "at least three");

    // The cut is the same for texture coordinates: it is given by numbers of corners.
    places_.clear();
    for (const Corner& c : corners)
      places_.push_back(file_.mesh.positions[static_cast<std::size_t>(c.vertex)]);
    triangles_.clear();
    const std::string expected = cut_polygon(places_, triangles_);
    if (!expected.empty()) refuse(element, std::to_string(corners.size()) + " corners", expected);

    // Polygons are remembered, because a rest shape has to be cut in the same way.
    const auto at = [&](Index c) { return corners[static_cast<std::size_t>(c)]; };
    if (corners.size() > 3) {
      FilePolygon& polygon = file_.polygons.emplace_back();
      polygon.first_face = static_cast<Index>(file_.mesh.faces.size());
      polygon.face_count = static_cast<Index>(triangles_.size());
      for (const Corner& c : corners) polygon.corners.push_back(c.vertex);
    }
    for (const Triangle& t : triangles_) add_triangle({at(t[0]), at(t[1]), at(t[2])});
  }

  void add_triangle(const std::array<Corner, 3>& corners) {
    TriangleMesh& mesh = file_.mesh;
    if (mesh.faces.size() >= kLargestCount)
      refuse("face " + std::to_string(faces_), "one more", "at most 536870911 triangles");
    mesh.faces.push_back({corners[0].vertex, corners[1].vertex, corners[2].vertex});
    for (const Corner& c : corners) all_have_uv_ = all_have_uv_ && c.uv != kNone;
    if (!all_have_uv_) return;
    const auto uv = [&](std::size_t c) { return uv_[static_cast<std::size_t>(corners[c].uv)]; };
    mesh.uv.push_back({uv(0), uv(1), uv(2)});
  }

  void close_group() {
    const auto end = static_cast<Index>(file_.mesh.faces.size());
    group_.face_count = end - group_.first_face;
    if (group_.name.empty()) group_.name = std::filesystem::path(path_).stem().string();
    if (group_.face_count > 0) file_.groups.push_back(group_);
    group_ = {"", end, 0};
  }

  std::string_view text_;
  const std::string& path_;
  MeshFile file_;
  MeshGroup group_;
  std::vector<Vec2d> uv_;
  std::size_t line_ = 1, next_line_ = 1;  ///< of the statement that is read, and of the text left
  std::string joined_;                    ///< a statement of several lines
  std::size_t faces_ = 0;
  std::vector<Vec3d> places_;  ///< of the corners of a face
  std::vector<Triangle> triangles_;
  bool all_have_uv_ = true;
};

}  // namespace

MeshFile parse_obj(std::string_view text, const std::string& path) {
  return ObjParser(text, path).parse();
}

}  // namespace icloth
