#include "sim/bodies/retarget.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/index.h"
#include "sim/bodies/node_pose.h"
#include "sim/bodies/rig_pose.h"

namespace icloth {
namespace {

using Eigen::Matrix3d, Eigen::Quaterniond, Eigen::Vector3d;

constexpr std::size_t kLeastPairs = 3;

Vector3d place_of(const Affine& map) { return {map.m[3], map.m[7], map.m[11]}; }

/// The 24 turns that take axes to axes, the one that turns nothing first.
std::vector<Matrix3d> axis_turns() {
  std::vector<Matrix3d> turns = {Matrix3d::Identity()};
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int signs = 0; signs < 4 && x != y; ++signs) {
        const Vector3d a = (signs & 1 ? -1 : 1) * Vector3d::Unit(x);
        const Vector3d b = (signs & 2 ? -1 : 1) * Vector3d::Unit(y);
        Matrix3d turn;
        turn << a, b, a.cross(b);
        turns.push_back(turn);
      }
  return turns;
}

bool is_below(const Rig& rig, Index node, Index above) {
  while (node != kNone && node != above) node = rig.parent[at(node)];
  return node == above;
}

/// The shortest turn from one direction to another; for opposite ones, half a turn about any axis
/// across them. Eigen's FromTwoVectors is not used, since it takes the compiler ten seconds.
Matrix3d shortest_turn(const Vector3d& from, const Vector3d& to) {
  const Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = a.dot(b);
  if (cosine < -1 + 1e-12)
    return Eigen::AngleAxisd(std::numbers::pi, a.unitOrthogonal()).toRotationMatrix();
  const double twice_w = std::sqrt(2 * (1 + cosine));
  const Vector3d axis = (1 / twice_w) * a.cross(b);
  return Quaterniond(twice_w / 2, axis.x(), axis.y(), axis.z()).toRotationMatrix();
}

/// Everything about two skeletons that does not change over time.
class Retarget {
 public:
  Retarget(const Rig& motion, const Rig& body, const std::vector<NodePair>& pairs, Vec3d up)
      : motion_(motion),
        body_(body),
        pairs_(pairs),
        up_(to_eigen(up)),
        joint_rest_(pose_nodes(motion, nullptr, {})),
        node_rest_(pose_nodes(body, nullptr, {})),
        pair_of_node_(body.parent.size(), kNone),
        is_in_hand_(pairs.size(), false) {
    for (std::size_t p = 0; p < pairs.size(); ++p)
      pair_of_node_[at(pairs[p].node)] = static_cast<Index>(p);
    find_axes();
    find_scale();
    find_alignments();
  }

  Retargeted run() {
    const Clip& from = motion_.clips[0];
    find_reference(from);

    // Each node of a pair turns, and the root moves as well.
    Retargeted result{.clip = {}, .scale = scale_, .turned = turned_, .moved = moved_};
    Clip& clip = result.clip;
    clip.name = from.name;
    clip.duration = from.duration;
    clip.channels.resize(pairs_.size());
    for (std::size_t p = 0; p < pairs_.size(); ++p) clip.channels[p].node = pairs_[p].node;
    for (const double time : key_times(from)) add_keys(from, time, clip);
    return result;
  }

 private:
  Vector3d joint_place(std::size_t pair) const {
    return axes_ * place_of(joint_rest_[at(pairs_[pair].joint)]);
  }
  Vector3d node_place(std::size_t pair) const {
    return place_of(node_rest_[at(pairs_[pair].node)]);
  }

  /// Of all turns by right angles the one with which the joints lie most like the nodes. Another
  /// one than none has to be clearly better.
  void find_axes() {
    constexpr double kClearly = 1.1;
    std::vector<double> likeness;
    const std::vector<Matrix3d> turns = axis_turns();
    for (const Matrix3d& turn : turns) {
      double sum = 0;
      for (std::size_t p = 1; p < pairs_.size(); ++p)
        sum += (turn * (joint_place(p) - joint_place(0))).dot(node_place(p) - node_place(0));
      likeness.push_back(sum);
    }

    // The first turn is none.
    const auto best = std::ranges::max_element(likeness);
    turned_ = *best > kClearly * std::max(likeness[0], 0.0);
    if (turned_) axes_ = turns[static_cast<std::size_t>(best - likeness.begin())];
  }

  /// The ratio of the heights of the hips over the lowest pair, or of the largest distances from
  /// the hips where next to nothing is below them.
  void find_scale() {
    constexpr double kLeastPart = 0.1;  // of the largest distance
    double joint_low = 0, node_low = 0, joint_reach = 0, node_reach = 0;
    for (std::size_t p = 1; p < pairs_.size(); ++p) {
      const Vector3d joint = joint_place(p) - joint_place(0), node = node_place(p) - node_place(0);
      joint_low = std::max(joint_low, -up_.dot(joint));
      node_low = std::max(node_low, -up_.dot(node));
      joint_reach = std::max(joint_reach, joint.norm());
      node_reach = std::max(node_reach, node.norm());
    }
    if (joint_low > kLeastPart * joint_reach && node_low > kLeastPart * node_reach)
      scale_ = node_low / joint_low;
    else if (joint_reach > 0)
      scale_ = node_reach / joint_reach;
  }

  /// The turns from the limbs of the body to those of the motion. A joint above comes first, so
  /// that a hand finds that of its forearm.
  void find_alignments() {
    alignment_.assign(pairs_.size(), Matrix3d::Identity());
    for (std::size_t p = 1; p < pairs_.size(); ++p) {
      // The pair above, and the part of the body; the name of the joint may be the one that tells.
      const std::size_t above = pair_above(p);
      const std::string own = part_of(p), upper = part_of(above);
      const bool is_limb_end = (own.starts_with("forearm") && upper.starts_with("upper_arm")) ||
                               (own.starts_with("hand") && upper.starts_with("forearm")) ||
                               (own.starts_with("shin") && upper.starts_with("thigh")) ||
                               (own.starts_with("foot") && upper.starts_with("shin"));

      // The limb of the body is turned to where that of the motion points.
      const Vector3d wanted = joint_place(p) - joint_place(above);
      const Vector3d has = node_place(p) - node_place(above);
      if (is_limb_end && wanted.norm() > 0 && has.norm() > 0)
        alignment_[above] = shortest_turn(has, wanted);
    }

    // A hand, and what is in it, keeps to its forearm.
    for (std::size_t p = 1; p < pairs_.size(); ++p) {
      const std::size_t above = pair_above(p);
      const bool in_hand = part_of(p).starts_with("hand") || is_in_hand_[above];
      if (in_hand) alignment_[p] = alignment_[above];
      is_in_hand_[p] = in_hand;
    }
  }

  std::string part_of(std::size_t pair) const {
    const std::string part = part_name(body_.names[at(pairs_[pair].node)]);
    return part.empty() ? part_name(motion_.names[at(pairs_[pair].joint)]) : part;
  }

  /// The nearest pair whose joint is above that of another; the root is above all.
  std::size_t pair_above(std::size_t pair) const {
    for (Index joint = motion_.parent[at(pairs_[pair].joint)]; joint != kNone;
         joint = motion_.parent[at(joint)]) {
      const auto found = std::ranges::lower_bound(pairs_, joint, {}, &NodePair::joint);
      if (found != pairs_.end() && found->joint == joint)
        return static_cast<std::size_t>(found - pairs_.begin());
    }
    return 0;
  }

  /// Where the hips of the motion are when those of the body are at their place in the bind pose.
  void find_reference(const Clip& clip) {
    // The rest pose stands where the motion starts, or else the ground of the motion is at 0.
    const Vector3d rest = joint_place(0);
    const Affine start = pose_nodes(motion_, &clip, {0, 1})[at(pairs_[0].joint)];
    const Vector3d first = axes_ * place_of(start);
    double lowest = up_.dot(rest);
    for (const Affine& joint : joint_rest_)
      lowest = std::min(lowest, up_.dot(axes_ * place_of(joint)));
    const double height = up_.dot(rest) - lowest, at_rest = up_.dot(rest);
    const double at_start = up_.dot(first);
    const bool is_over_ground = std::abs(at_start - at_rest) > 0.5 * height &&
                                std::abs(at_start - height) < std::abs(at_start - at_rest);
    reference_ = rest + (is_over_ground ? height - at_rest : 0) * up_;

    // A motion that starts somewhere else in a studio starts at the place of the body instead.
    Vector3d away = first - rest;
    away -= up_.dot(away) * up_;
    if (away.norm() <= 0.5 * height) return;
    reference_ += away;
    moved_ = scale_ * away.norm();
  }

  /// The times of the longest list of keys.
  static std::vector<double> key_times(const Clip& clip) {
    std::vector<double> times;
    const auto take = [&](const auto& keys) {
      if (keys.size() <= times.size()) return;
      times.clear();
      for (const auto& key : keys) times.push_back(key.time);
    };
    for (const NodeChannel& channel : clip.channels) {
      take(channel.translation);
      take(channel.rotation);
    }
    return times;
  }

  /// Places all nodes of the body at a time, parents before their children, and notes how each node
  /// of a pair is against its parent.
  void add_keys(const Clip& from, double time, Clip& clip) {
    const std::vector<Affine> joints = pose_nodes(motion_, &from, {time, 1});
    nodes_.resize(body_.parent.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Affine above = body_.parent[n] == kNone ? Affine{} : nodes_[at(body_.parent[n])];
      nodes_[n] = above * body_.local[n];
      if (pair_of_node_[n] == kNone) continue;
      const std::size_t p = at(pair_of_node_[n]);
      const Affine& joint = joints[at(pairs_[p].joint)];

      // A parent that is flat along an axis leaves no turn to be found: its child stays as it is.
      const Eigen::FullPivLU<Matrix3d> parent(linear_part(above));
      if (!parent.isInvertible()) continue;

      // The turn of the joint on top of the bind pose, seen from the parent as it is now.
      const Matrix3d turn = axes_ * linear_part(joint) * axes_.transpose() * alignment_[p];
      NodePose pose = parts_of(body_.local[n]);
      const Matrix3d turned = parent.solve(turn * linear_part(node_rest_[n]));
      pose.rotation = parts_of(make_affine(turned, Vector3d::Zero())).rotation;
      const Quaterniond& q = pose.rotation;
      clip.channels[p].rotation.push_back({time, q.w(), q.x(), q.y(), q.z()});

      // The root goes where the hips of the motion go.
      if (p == 0) {
        const Vector3d moved = scale_ * (axes_ * place_of(joint) - reference_);
        pose.translation = parent.solve(place_of(node_rest_[n]) + moved - place_of(above));
        clip.channels[p].translation.push_back({time, from_eigen(pose.translation)});
      }
      nodes_[n] = above * pose.affine();
    }
  }

  const Rig& motion_;
  const Rig& body_;
  const std::vector<NodePair>& pairs_;
  Vector3d up_;
  std::vector<Affine> joint_rest_, node_rest_;  ///< in the spaces of the files
  std::vector<Index> pair_of_node_;             ///< kNone: keeps its place (nodes)
  std::vector<Matrix3d> alignment_;             ///< A (pairs)
  std::vector<bool> is_in_hand_;                ///< (pairs)
  Matrix3d axes_ = Matrix3d::Identity();        ///< Q
  double scale_ = 1, moved_ = 0;
  bool turned_ = false;
  Vector3d reference_ = Vector3d::Zero();  ///< in the axes of the body, the lengths of the motion
  std::vector<Affine> nodes_;              ///< at the time of the keys that are being added
};

}  // namespace

std::optional<NodePair> root_pair(const Rig& motion, const std::vector<NodePair>& pairs) {
  if (pairs.size() < kLeastPairs) return std::nullopt;
  for (const NodePair pair : pairs)
    if (!is_below(motion, pair.joint, pairs[0].joint)) return std::nullopt;
  return pairs[0];
}

Retargeted retarget(const Rig& motion, const Rig& body, const std::vector<NodePair>& pairs,
                    Vec3d up) {
  return Retarget(motion, body, pairs, up).run();
}

}  // namespace icloth
