#include "sim/files/bvh_io.h"

#include <charconv>
#include <cmath>
#include <numbers>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::size_t kMostJoints = 10'000;
constexpr std::size_t kLongestName = 1000;  // [bytes]
constexpr std::size_t kMostChannels = 6;    // of a joint
constexpr double kMostFrames = 1e6;
constexpr double kLargestAngle = 1e6;  // [degrees]
constexpr double kLongestFrame = 1e3;  // [s]

constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// What one number of a frame says about its joint.
struct ChannelKind {
  bool is_angle;
  int axis;  ///< 0: x, 1: y, 2: z
};

RotationKey turn(int axis, double degrees) {
  const double half = degrees * std::numbers::pi / 360;
  RotationKey key{0, std::cos(half), 0, 0, 0};
  (axis == 0 ? key.x : axis == 1 ? key.y : key.z) = std::sin(half);
  return key;
}

/// The rotation b in the axes that a has turned.
RotationKey product(const RotationKey& a, const RotationKey& b) {
  return {0, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
          a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
          a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
}

class BvhParser {
 public:
  BvhParser(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  Rig parse() {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    expect("HIERARCHY");
    parse_joints();
    parse_motion();
    rig_.weight_first = {0};
    return std::move(rig_);
  }

 private:
  [[noreturn]] void refuse(std::string_view value, const std::string& expected) const {
    throw InputError(shown_path(path_) + ": line " + std::to_string(line_) + ": value " +
                     (value.empty() ? "(end of file)" : in_quotes(value)) + ", expected " +
                     expected);
  }

  /// The next word, empty at the end of the text.
  std::string_view word() {
    const std::size_t begin = std::min(rest_.find_first_not_of(kBlanks), rest_.size());
    for (const char c : rest_.substr(0, begin)) line_ += c == '\n' ? 1 : 0;
    const std::size_t end = std::min(rest_.find_first_of(kBlanks, begin), rest_.size());
    const std::string_view found = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return found;
  }

  void expect(std::string_view wanted) {
    const std::string_view found = word();
    if (found != wanted) refuse(found, std::string(wanted));
  }

  double number(double least, double most, const std::string& expected) {
    const std::string_view found = word();
    const std::string_view digits = found.substr(found.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_number = error == std::errc{} && end == digits.data() + digits.size();
    if (!is_number || !(value >= least && value <= most)) refuse(found, expected);
    return value;
  }

  /// Joints inside each other. No recursion, so that a deep file needs no deep stack.
  void parse_joints() {
    Index open = kNone;  // the joint whose block is being read
    for (;;) {
      const std::string_view key = word();
      const bool inside = open != kNone;
      if (key == "MOTION" && !inside) break;

      // What may come next depends on whether a block is open.
      if ((key == "ROOT" && !inside) || (key == "JOINT" && inside) || (key == "End" && inside))
        open = begin_joint(open, key == "End");
      else if (key == "OFFSET" && inside)
        parse_offset(open);
      else if (key == "CHANNELS" && inside)
        parse_channels(open);
      else if (key == "}" && inside)
        open = end_joint(open);
      else
        refuse(key, inside ? "OFFSET, CHANNELS, JOINT, End Site or }" : "ROOT or MOTION");
    }
    if (rig_.parent.empty()) refuse("MOTION", "ROOT with at least one joint before it");
  }

  /// The name is what follows on the line; the block may be opened there or on the next one.
  Index begin_joint(Index parent, bool is_end) {
    std::string_view name = rest_.substr(0, kLongestName + 1);
    name = name.substr(0, name.find_first_of("\n{"));
    if (name.size() > kLongestName)
      refuse(name, "a name of at most " + std::to_string(kLongestName) + " bytes");
    rest_.remove_prefix(name.size());

    // Blanks around the name are none of it.
    const std::size_t begin = std::min(name.find_first_not_of(kBlanks), name.size());
    name = name.substr(begin, name.find_last_not_of(kBlanks) + 1 - begin);
    if (name.empty()) refuse("{", "a name before it");
    if (rest_.starts_with('{'))
      rest_.remove_prefix(1);
    else
      expect("{");

    // Parents come before their children, as in every rig.
    if (rig_.parent.size() >= kMostJoints)
      refuse(name, "at most " + std::to_string(kMostJoints) + " joints");
    rig_.names.emplace_back(is_end ? std::string_view() : name);
    rig_.parent.push_back(parent);
    rig_.local.emplace_back();
    channels_.emplace_back();
    has_channels_.push_back(is_end);
    return static_cast<Index>(rig_.parent.size()) - 1;
  }

  Index end_joint(Index joint) const {
    if (!has_channels_[at(joint)])
      refuse("}", "CHANNELS of joint " + in_quotes(rig_.names[at(joint)]) + " before it");
    return rig_.parent[at(joint)];
  }

  void parse_offset(Index joint) {
    for (int row = 0; row < 3; ++row)
      rig_.local[at(joint)].m[4 * row + 3] =
          number(-kLargestCoordinate, kLargestCoordinate, "three finite coordinates");
  }

  void parse_channels(Index joint) {
    if (has_channels_[at(joint)]) refuse("CHANNELS", "them once, and none of an end");
    has_channels_[at(joint)] = true;
    const double count = number(0, kMostChannels, "a number of channels from 0 to 6");
    for (double k = 0; k < count; ++k) {
      const std::string_view name = word();
      const std::string_view kind = name.substr(std::min<std::size_t>(name.size(), 1));
      const bool is_known =
          (kind == "position" || kind == "rotation") && name[0] >= 'X' && name[0] <= 'Z';
      if (!is_known)
        refuse(name,
               "Xposition, Yposition, Zposition, Xrotation, Yrotation or "
               "Zrotation");
      channels_[at(joint)].push_back({kind == "rotation", name[0] - 'X'});
    }
  }

  void parse_motion() {
    std::size_t channels = 0;
    for (const auto& list : channels_) channels += list.size();
    if (channels == 0) refuse("MOTION", "joints with at least one channel before it");

    // A number takes two bytes at least, which bounds the frames before memory is taken for them.
    expect("Frames:");
    const double fitting = static_cast<double>((rest_.size() + 1) / 2 / channels);
    const double most = std::min(kMostFrames, fitting);
    const double frames =
        number(1, most,
               "1 to " + number_text(most) + " frames of " + std::to_string(channels) +
                   " numbers, as many as the file has room for");
    expect("Frame");
    expect("Time:");
    const double step = number(1e-6, kLongestFrame, "seconds from 1e-6 to 1000");
    read_frames(static_cast<std::size_t>(frames), step);
    if (const std::string_view more = word(); !more.empty())
      refuse(more, "the end of the file after " + number_text(frames) + " frames of " +
                       std::to_string(channels) + " numbers");
  }

  void read_frames(std::size_t frames, double step) {
    Clip& clip = rig_.clips.emplace_back();
    clip.duration = step * static_cast<double>(frames - 1);

    // Each joint gets a list of keys for what its channels say.
    for (std::size_t joint = 0; joint < channels_.size(); ++joint) {
      if (channels_[joint].empty()) continue;
      NodeChannel& moved = clip.channels.emplace_back();
      moved.node = static_cast<Index>(joint);
      for (const ChannelKind kind : channels_[joint]) {
        if (kind.is_angle) moved.rotation.resize(frames);
        if (!kind.is_angle) moved.translation.resize(frames);
      }
    }

    // The numbers of a frame follow each other in the order of the joints.
    for (std::size_t f = 0; f < frames; ++f)
      for (NodeChannel& moved : clip.channels) read_frame(f, step * static_cast<double>(f), moved);
  }

  /// The numbers of one joint in one frame.
  void read_frame(std::size_t frame, double time, NodeChannel& moved) {
    const double* offset = rig_.local[at(moved.node)].m;

    // The channels of a joint follow each other: places replace its offset, turns add up.
    double place[3] = {offset[3], offset[7], offset[11]};
    RotationKey turned{0, 1, 0, 0, 0};
    for (const ChannelKind kind : channels_[at(moved.node)]) {
      const double most = kind.is_angle ? kLargestAngle : kLargestCoordinate;
      const double value = number(-most, most, kind.is_angle ? kAngle : kPosition);
      if (kind.is_angle)
        turned = product(turned, turn(kind.axis, value));
      else
        place[kind.axis] = value;
    }

    turned.time = time;
    if (!moved.rotation.empty()) moved.rotation[frame] = turned;
    if (!moved.translation.empty())
      moved.translation[frame] = {time, {place[0], place[1], place[2]}};
  }

  const std::string kAngle = "an angle in degrees";
  const std::string kPosition = "a finite coordinate";

  std::string_view rest_;
  const std::string& path_;
  std::size_t line_ = 1;
  Rig rig_;
  std::vector<std::vector<ChannelKind>> channels_;  ///< in the order of their numbers (nodes)
  std::vector<bool> has_channels_;                  ///< (nodes)
};

}  // namespace

Rig parse_bvh(std::string_view text, const std::string& path) {
  return BvhParser(text, path).parse();
}

}  // namespace icloth
