#include "sim/pattern/dxf_pieces.h"

#include <charconv>
#include <cmath>

#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/pattern/pattern.h"

namespace icloth {
namespace {

constexpr double kLargestNumber = 1e6;
constexpr std::size_t kMostTexts = 100, kMostCorners = 1000;  ///< of one piece

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// One pair of lines: what the value means, and the value.
struct Group {
  int code = 0;
  std::string_view value;
};

/// Walks over the groups of a file.
class GroupReader {
 public:
  GroupReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// The next group; false at the end of the file.
  bool next(Group& group) {
    std::string_view code;
    do {
      if (!line(code)) return false;
    } while (code.empty());
    const char* end = code.data() + code.size();
    const auto [rest, error] = std::from_chars(code.data(), end, group.code);
    if (error != std::errc{} || rest != end) refuse(code, "the number of a DXF group");
    if (!line(group.value)) refuse("(end of file)", "the value of a DXF group");
    return true;
  }

  double number(std::string_view value) const {
    double number = 0;
    if (value.starts_with('+')) value.remove_prefix(1);
    const char* end = value.data() + value.size();
    const auto [rest, error] = std::from_chars(value.data(), end, number);
    if (error != std::errc{} || rest != end || !(std::fabs(number) <= kLargestNumber))
      refuse(value, "a number from -1e6 to 1e6");
    return number;
  }

  [[noreturn]] void refuse(std::string_view value, const std::string& expected) const {
    throw InputError(name_ + ": line " + std::to_string(line_) + ": value " + in_quotes(value) +
                     ", expected " + expected);
  }

 private:
  bool line(std::string_view& result) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    result = trimmed(text_.substr(at_, end - at_));
    at_ = end + 1;
    ++line_;
    return true;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0, line_ = 0;
};

/// Collects the entities of blocks.
class PieceReader {
 public:
  PieceReader(std::string_view text, const std::string& name) : groups_(text, name) {}

  std::vector<DxfPiece> read() {
    Group group;
    while (groups_.next(group)) {
      if (group.code != 0) {
        read_property(group);
        continue;
      }
      finish_entity();
      begin_entity(group.value);
      if (group.value == "EOF") break;
    }
    finish_entity();
    return std::move(pieces_);
  }

 private:
  DxfPiece& piece() { return pieces_.back(); }

  void begin_entity(std::string_view kind) {
    kind_ = kind;
    layer_ = 0;
    text_ = {};
    if (kind == "ENDBLK") in_block_ = false;
    if (kind == "BLOCK") {
      if (pieces_.size() == kMostPanels)
        groups_.refuse(kind, "at most " + std::to_string(kMostPanels) + " blocks");
      in_block_ = true;
      pieces_.emplace_back();
    }
    if (!in_block_) return;

    // The vertices of a polyline are entities of their own, up to SEQEND.
    if (kind == "POLYLINE" || kind == "LWPOLYLINE" || kind == "LINE") {
      piece().lines.emplace_back();
      in_polyline_ = kind == "POLYLINE";
    } else if (kind != "VERTEX") {
      in_polyline_ = false;
    }
    point_ = {};
    if (kind == "VERTEX" && !in_polyline_) kind_ = "";
  }

  void read_property(const Group& group) {
    if (!in_block_) return;
    if (kind_ == "BLOCK" && group.code == 2) piece().block = group.value;
    if (kind_ == "TEXT" && group.code == 1) text_ = group.value;
    const bool is_line = kind_ == "POLYLINE" || kind_ == "LWPOLYLINE" || kind_ == "LINE";
    if (group.code == 8) {
      // Layers with other names than numbers mean nothing here.
      layer_ = 0;
      std::from_chars(group.value.data(), group.value.data() + group.value.size(), layer_);
      if (is_line) piece().lines.back().layer = layer_;
    }
    if (group.code == 70 && is_line && kind_ != "LINE")
      piece().lines.back().closed = static_cast<int>(groups_.number(group.value)) % 2 != 0;

    // A line has its second point in the groups 11 and 21.
    const bool has_points = is_line ? kind_ != "POLYLINE" : kind_ == "VERTEX" || kind_ == "POINT";
    if (!has_points) return;
    if (group.code == 10 || (group.code == 11 && kind_ == "LINE"))
      point_.x = groups_.number(group.value);
    if (group.code == 20 || (group.code == 21 && kind_ == "LINE")) {
      point_.y = groups_.number(group.value);
      if (is_line) add_point();
    }
  }

  void add_point() {
    if (++points_ > kMostOutlinePoints)
      groups_.refuse(kind_, "at most " + std::to_string(kMostOutlinePoints) + " points");
    piece().lines.back().points.push_back(point_);
  }

  void finish_entity() {
    if (!in_block_) return;
    if (kind_ == "VERTEX") add_point();
    if (kind_ == "POINT" && layer_ == 2 && piece().corners.size() < kMostCorners)
      piece().corners.push_back(point_);
    if (kind_ == "TEXT" && piece().texts.size() < kMostTexts) piece().texts.emplace_back(text_);
  }

  GroupReader groups_;
  std::vector<DxfPiece> pieces_;
  bool in_block_ = false, in_polyline_ = false;
  std::string_view kind_;  ///< of the entity that is read
  std::string_view text_;
  int layer_ = 0;
  Vec2d point_;
  std::size_t points_ = 0;  ///< of the whole file
};

}  // namespace

std::vector<DxfPiece> read_dxf_pieces(std::string_view text, const std::string& name) {
  return PieceReader(text, name).read();
}

}  // namespace icloth
