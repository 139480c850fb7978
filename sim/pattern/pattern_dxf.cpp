// Panels from a DXF file: the outline of each piece, divided at its corners, unfolded at its mirror
// line and turned to its grain.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/pattern/dxf_pieces.h"
#include "sim/pattern/pattern.h"
#include "sim/pattern/pattern_checks.h"

namespace icloth {
namespace {

constexpr int kCutLine = 1, kMirrorLine = 6, kGrainLine = 7, kSewLine = 14;
constexpr double kSamePlace = 5e-4;                   ///< points that are nearer are one [m]
constexpr double kLargestExtentCm = 300;              ///< of a piece in cm; larger ones are in mm
constexpr double kCornerCosine = 0.9396926207859084;  ///< of 20°
constexpr std::size_t kMostParts = 200;               ///< lines that make one outline

using Points = std::vector<Vec2d>;

double norm_of(Vec2d a) { return std::sqrt(a.x * a.x + a.y * a.y); }
bool is_same_place(Vec2d a, Vec2d b) { return norm_of(a - b) < kSamePlace; }

/// What follows a key such as "Quantity:" in one of the texts; empty where it is missing.
std::string text_after(const DxfPiece& piece, std::string_view key) {
  for (const std::string& text : piece.texts) {
    const auto same = [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) ==
             std::tolower(static_cast<unsigned char>(b));
    };
    if (text.size() < key.size() || !std::equal(key.begin(), key.end(), text.begin(), same))
      continue;
    const std::size_t begin = text.find_first_not_of(' ', key.size());
    return begin == std::string::npos ? "" : text.substr(begin);
  }
  return "";
}

/// The point on the other side of the line through a and b.
Vec2d mirrored(Vec2d p, Vec2d a, Vec2d b) {
  const Vec2d along = b - a, from = p - a;
  const double t = (from.x * along.x + from.y * along.y) / (along.x * along.x + along.y * along.y);
  return 2.0 * (a + t * along) - p;
}

/// One outline: a loop of points, and which of them are corners.
struct Outline {
  Points points;
  std::vector<char> is_corner;
};

class DxfPattern {
 public:
  DxfPattern(std::string_view text, const std::string& name)
      : pieces_(read_dxf_pieces(text, name)) {
    pattern_.file = name;
  }

  Pattern read() {
    set_unit();
    for (const DxfPiece& piece : pieces_) read_piece(piece);
    if (pattern_.panels.empty())
      throw InputError(pattern_.file +
                       ": value 0 pieces, expected a BLOCK with an outline on layer 14 or 1");
    note("DXF holds no stitches and no placement around a body");
    check_pattern(pattern_);
    return std::move(pattern_);
  }

 private:
  void note(const std::string& text) { pattern_.notes.push_back(pattern_.file + ": " + text); }

  void set_unit();
  void read_piece(const DxfPiece& piece);
  Points outline_of(const DxfPiece& piece, int layer) const;
  std::vector<char> corners_of(const DxfPiece& piece, const Points& points) const;
  bool unfold(Outline& outline, Vec2d a, Vec2d b) const;
  std::optional<std::array<Vec2d, 2>> line_of(const DxfPiece& piece, int layer) const;
  std::string free_name(const DxfPiece& piece, const std::string& addition);
  void add_panel(const Outline& outline, const std::string& name, const std::string& place);

  std::vector<DxfPiece> pieces_;
  Pattern pattern_;
  double metre_ = 0.01;  ///< length of a unit of the file
  std::set<std::string> names_;
  std::size_t edges_ = 0;
};

/// Units are not reliable in these files: the size of the largest piece decides, except for inches.
void DxfPattern::set_unit() {
  // The largest extent of all outlines, in units of the file.
  double extent = 0;
  bool is_english = false;
  for (const DxfPiece& piece : pieces_) {
    is_english = is_english || text_after(piece, "Units:").starts_with("ENGLISH");
    for (const DxfLine& line : piece.lines) {
      if (line.layer != kCutLine && line.layer != kSewLine) continue;
      const auto [left, right] = std::ranges::minmax_element(line.points, {}, &Vec2d::x);
      const auto [low, high] = std::ranges::minmax_element(line.points, {}, &Vec2d::y);
      if (line.points.empty()) continue;
      extent = std::max({extent, right->x - left->x, high->y - low->y});
    }
  }

  // A garment has a piece of more than 30 cm, and hardly one of more than 3 m.
  metre_ = is_english ? 0.0254 : extent > kLargestExtentCm ? 0.001 : 0.01;
  note(std::string("its units are taken as ") +
       (is_english                  ? "inches"
        : extent > kLargestExtentCm ? "millimetres"
                                    : "centimetres") +
       ", the largest piece is then " + rounded_text(extent * metre_) + " m");
}

/// The loop of a layer. It may be one polyline or several lines that meet end to end. Empty where
/// there is none, or where it is not closed.
Points DxfPattern::outline_of(const DxfPiece& piece, int layer) const {
  // The parts in metres, without points that repeat the one before.
  std::vector<Points> parts;
  for (const DxfLine& line : piece.lines) {
    if (line.layer != layer || line.points.size() < 2 || parts.size() == kMostParts) continue;
    Points points;
    for (const Vec2d& p : line.points)
      if (points.empty() || !is_same_place(points.back(), metre_ * p)) points.push_back(metre_ * p);
    if (points.size() < 2) continue;
    if (line.closed && !is_same_place(points.front(), points.back()))
      points.push_back(points.front());
    parts.push_back(std::move(points));
  }
  if (parts.empty()) return {};

  // The first part is followed by the one that begins or ends where it ends, and so on.
  Points loop = std::move(parts.front());
  parts.erase(parts.begin());
  while (!is_same_place(loop.front(), loop.back())) {
    const auto next = std::ranges::find_if(parts, [&](const Points& part) {
      return is_same_place(part.front(), loop.back()) || is_same_place(part.back(), loop.back());
    });
    if (next == parts.end()) return {};
    if (!is_same_place(next->front(), loop.back())) std::ranges::reverse(*next);
    loop.insert(loop.end(), next->begin() + 1, next->end());
    parts.erase(next);
  }
  loop.pop_back();
  return loop;
}

/// The two ends of a line on a layer.
std::optional<std::array<Vec2d, 2>> DxfPattern::line_of(const DxfPiece& piece, int layer) const {
  for (const DxfLine& line : piece.lines) {
    if (line.layer != layer || line.points.size() < 2) continue;
    const Vec2d a = metre_ * line.points.front(), b = metre_ * line.points.back();
    if (!is_same_place(a, b)) return std::array{a, b};
  }
  return std::nullopt;
}

/// Corners are the turn points of the file, or where it has none, points where the outline turns by
/// more than 20°. A loop without corners gets two.
std::vector<char> DxfPattern::corners_of(const DxfPiece& piece, const Points& points) const {
  // Turn points are looked up by their first coordinate.
  const std::size_t n = points.size();
  std::vector<char> is_corner(n, 0);
  std::vector<std::pair<double, double>> turns;
  for (const Vec2d& p : piece.corners) turns.emplace_back(metre_ * p.x, metre_ * p.y);
  std::ranges::sort(turns);
  for (std::size_t i = 0; i < n; ++i) {
    auto turn = std::ranges::lower_bound(turns, std::pair{points[i].x - kSamePlace, -1e300});
    for (; turn != turns.end() && turn->first <= points[i].x + kSamePlace && !is_corner[i]; ++turn)
      is_corner[i] = is_same_place(points[i], {turn->first, turn->second});
  }

  if (std::ranges::count(is_corner, 1) < 2) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2d a = points[i] - points[(i + n - 1) % n], b = points[(i + 1) % n] - points[i];
      if (a.x * b.x + a.y * b.y < kCornerCosine * norm_of(a) * norm_of(b)) is_corner[i] = 1;
    }
  }
  if (std::ranges::count(is_corner, 1) < 2) is_corner[0] = is_corner[n / 2] = 1;
  return is_corner;
}

/// Adds the other half of a piece that is drawn on the fold from a to b. Returns false where the
/// fold is not a part of the outline.
bool DxfPattern::unfold(Outline& outline, Vec2d a, Vec2d b) const {
  const std::size_t n = outline.points.size();
  const auto find = [&](Vec2d p) {
    const auto found =
        std::ranges::find_if(outline.points, [&](Vec2d q) { return is_same_place(p, q); });
    return static_cast<std::size_t>(found - outline.points.begin());
  };
  std::size_t from = find(b), to = find(a);
  if (from == n || to == n || from == to) return false;

  // The half runs from one end of the fold to the other; nothing may lie between them on the fold.
  if ((from + 1) % n == to) std::swap(from, to);
  if ((to + 1) % n != from) return false;
  Outline whole;
  for (std::size_t i = from;; i = (i + 1) % n) {
    whole.points.push_back(outline.points[i]);
    whole.is_corner.push_back(outline.is_corner[i]);
    if (i == to) break;
  }

  // Back along the mirrored half. Where the outline meets the fold at a right angle there is no
  // corner any more, but seams are easier to name where there is one.
  for (std::size_t i = n - 2; i > 0; --i) {
    whole.points.push_back(mirrored(whole.points[i], a, b));
    whole.is_corner.push_back(whole.is_corner[i]);
  }
  outline = std::move(whole);
  return true;
}

std::string DxfPattern::free_name(const DxfPiece& piece, const std::string& addition) {
  std::string name = text_after(piece, "Piece Name:");
  if (name.empty()) name = piece.block.empty() ? "piece" : piece.block;
  name = harmless(name) + addition;
  std::string free = name;
  for (int k = 2; !names_.insert(free).second; ++k)
    free = std::string(name).append(" ").append(std::to_string(k));
  return free;
}

void DxfPattern::read_piece(const DxfPiece& piece) {
  // The sew line is the net shape. Without it the cut line serves, which is wider.
  Outline outline;
  outline.points = outline_of(piece, kSewLine);
  const bool is_cut = outline.points.size() < 3;
  if (is_cut) outline.points = outline_of(piece, kCutLine);
  if (outline.points.size() < 3) return;
  const std::string name = free_name(piece, ""), place = "panel " + in_quotes(name);
  if (is_cut)
    note(place +
         ": has no sew line (layer 14), the cut line is taken: any seam allowance is part of it");

  outline.is_corner = corners_of(piece, outline.points);
  const auto fold = line_of(piece, kMirrorLine);
  if (fold && !unfold(outline, (*fold)[0], (*fold)[1]))
    note(place + ": the mirror line is not an edge of the outline and is passed over");

  // The grain becomes the direction of y.
  if (const auto grain = line_of(piece, kGrainLine)) {
    const Vec2d along = (*grain)[1] - (*grain)[0];
    const double length = norm_of(along), c = along.y / length, s = along.x / length;
    for (Vec2d& p : outline.points) p = {c * p.x - s * p.y, s * p.x + c * p.y};
  }

  // The panel stands around its middle.
  Vec2d middle;
  for (const Vec2d& p : outline.points)
    middle = middle + (1.0 / static_cast<double>(outline.points.size())) * p;
  for (Vec2d& p : outline.points) p = p - middle;
  add_panel(outline, name, place);

  // Of two pieces one is the mirror image of the other.
  const std::string quantity = text_after(piece, "Quantity:");
  int count = 1;
  std::from_chars(quantity.data(), quantity.data() + quantity.size(), count);
  if (count < 2 || pattern_.panels.size() >= kMostPanels) return;
  for (Vec2d& p : outline.points) p.x = -p.x;
  std::ranges::reverse(outline.points);
  std::ranges::reverse(outline.is_corner);
  const std::string copy = free_name(piece, " mirrored");
  add_panel(outline, copy, "panel " + in_quotes(copy));
}

/// Divides an outline at its corners, counter-clockwise.
void DxfPattern::add_panel(const Outline& outline, const std::string& name,
                           const std::string& place) {
  // A loop that turns clockwise is reversed.
  Points points = outline.points;
  std::vector<char> is_corner = outline.is_corner;
  double area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2d a = points[i], b = points[(i + 1) % points.size()];
    area += a.x * b.y - a.y * b.x;
  }
  if (area < 0) {
    std::ranges::reverse(points);
    std::ranges::reverse(is_corner);
  }

  // The loop begins at its first corner; each further corner ends an edge.
  const auto first = std::ranges::find(is_corner, 1) - is_corner.begin();
  std::rotate(points.begin(), points.begin() + first, points.end());
  std::rotate(is_corner.begin(), is_corner.begin() + first, is_corner.end());
  Panel panel;
  panel.name = name;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_corner[i]) {
      const auto number = static_cast<Index>(panel.corners.size());
      panel.corners.push_back(points[i]);
      panel.edges.emplace_back();
      panel.edges.back().start = number;
      panel.edges.back().end = number + 1;
    } else {
      panel.edges.back().points.push_back(points[i]);
      panel.edges.back().curve = EdgeCurve::polyline;
    }
  }
  panel.edges.back().end = 0;
  edges_ += panel.edges.size();
  if (edges_ > kMostPanelEdges)
    throw InputError(pattern_.file + ": " + place + ": value " + std::to_string(edges_) +
                     " edges up to this panel, expected at most " +
                     std::to_string(kMostPanelEdges));
  pattern_.panels.push_back(std::move(panel));
}

}  // namespace

Pattern parse_pattern_dxf(std::string_view text, const std::string& name) {
  return DxfPattern(text, name).read();
}

}  // namespace icloth
