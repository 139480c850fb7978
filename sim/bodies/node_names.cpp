#include "sim/bodies/node_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "kernels/index.h"

namespace icloth {
namespace {

/// A part of a body and its names in the usual skeletons, those that mean nothing else in front:
/// "shoulder" is an upper arm only where nothing else is.
struct Part {
  std::string_view name;
  bool has_side;
  std::array<std::string_view, 8> known;
};

constexpr Part kParts[] = {
    {"hips", false, {"hips", "pelvis", "hip"}},
    {"spine", false, {"spine", "abdomen", "lowerback", "waist", "spine1", "torso"}},
    {"chest", false, {"chest", "upperchest", "thorax", "spine2", "spine3", "spine1"}},
    {"neck", false, {"neck", "neck1", "neck01"}},
    {"head", false, {"head"}},
    {"upper_arm", true, {"upperarm", "uparm", "arm", "shldr", "shoulder"}},
    {"clavicle", true, {"clavicle", "collar", "collarbone", "shoulder"}},
    {"forearm", true, {"forearm", "lowerarm", "lowarm", "elbow"}},
    {"hand", true, {"hand", "wrist"}},
    {"thigh", true, {"thigh", "upperleg", "upleg", "hip"}},
    {"shin", true, {"shin", "lowerleg", "lowleg", "calf", "leg", "knee"}},
    {"foot", true, {"foot", "ankle"}},
    {"toe", true, {"toe", "toes", "toebase", "ball"}},
};

constexpr std::string_view kSeparators = " ._-";

/// The name behind what programs put in front of it.
std::string_view without_prefix(std::string_view name) {
  if (const std::size_t colon = name.find_last_of(":|"); colon != std::string_view::npos)
    name.remove_prefix(colon + 1);
  for (const std::string_view prefix : {"mixamorig", "Bip001", "Bip01", "DEF-", "ORG-"})
    if (name.size() > prefix.size() && name.starts_with(prefix)) name.remove_prefix(prefix.size());
  return name;
}

std::string lower(std::string_view text) {
  std::string result;
  for (const char c : text)
    result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string without_separators(std::string_view name) {
  std::string result = lower(name);
  std::erase_if(result, [](char c) { return kSeparators.find(c) != std::string_view::npos; });
  return result;
}

/// A name without its side, and the side: 'l', 'r', or 0 where it has none.
struct Sided {
  std::string name;
  char side = 0;
};

Sided split_side(std::string_view name) {
  // A word at an end of the name says it in full.
  name = without_prefix(name);
  name.remove_prefix(std::min(name.find_first_not_of(kSeparators), name.size()));
  const std::string plain = without_separators(name);
  for (const std::string_view word : {"left", "right"}) {
    if (plain.starts_with(word)) return {plain.substr(word.size()), word[0]};
    if (plain.ends_with(word)) return {plain.substr(0, plain.size() - word.size()), word[0]};
  }

  // A letter does so where it is set apart: "thigh.L", "L_Thigh", "lThigh".
  if (name.size() < 3) return {plain, 0};
  const auto side_of = [](char c) {
    const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return letter == 'l' || letter == 'r' ? letter : '\0';
  };
  const auto separates = [](char c) { return kSeparators.find(c) != std::string_view::npos; };
  const bool is_camel =
      (name[0] == 'l' || name[0] == 'r') && std::isupper(static_cast<unsigned char>(name[1])) != 0;
  if (const char side = side_of(name.back()); side != 0 && separates(name[name.size() - 2]))
    return {plain.substr(0, plain.size() - 1), side};
  if (const char side = side_of(name[0]); side != 0 && (separates(name[1]) || is_camel))
    return {plain.substr(1), side};
  return {plain, 0};
}

/// The rank of a name among those of a part; npos: it is none of them.
std::size_t rank_in(const Part& part, char side, const Sided& name) {
  if (name.side != side || name.name.empty()) return std::string_view::npos;
  const auto found = std::ranges::find(part.known, std::string_view(name.name));
  return found == part.known.end() ? std::string_view::npos
                                   : static_cast<std::size_t>(found - part.known.begin());
}

std::vector<Sided> split_all(const std::vector<std::string>& names) {
  std::vector<Sided> all;
  for (const std::string& name : names) all.push_back(split_side(name));
  return all;
}

/// The free name that stands most clearly for a part, kNone where there is none.
Index find_part(const Part& part, char side, const std::vector<Sided>& names,
                const std::vector<bool>& taken) {
  Index best = kNone;
  std::size_t best_rank = std::string_view::npos;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::size_t rank = taken[k] ? std::string_view::npos : rank_in(part, side, names[k]);
    if (rank >= best_rank) continue;
    best = static_cast<Index>(k);
    best_rank = rank;
  }
  return best;
}

/// Pairs that grow, and who is in one already.
class Pairing {
 public:
  Pairing(std::size_t joints, std::size_t nodes, const std::vector<NodePair>& given)
      : joint_taken_(joints, false), node_taken_(nodes, false) {
    for (const NodePair pair : given) add(pair);
  }

  void add(NodePair pair) {
    joint_taken_[at(pair.joint)] = node_taken_[at(pair.node)] = true;
    pairs_.push_back(pair);
  }
  const std::vector<bool>& joint_taken() const { return joint_taken_; }
  const std::vector<bool>& node_taken() const { return node_taken_; }

  std::vector<NodePair> take() {
    std::ranges::sort(pairs_, {}, &NodePair::joint);
    return std::move(pairs_);
  }

 private:
  std::vector<NodePair> pairs_;
  std::vector<bool> joint_taken_, node_taken_;
};

}  // namespace

std::string plain_name(std::string_view name) { return without_separators(without_prefix(name)); }

std::string part_name(std::string_view name) {
  const Sided split = split_side(name);
  for (const Part& part : kParts)
    for (const char side : part.has_side ? std::string_view("lr") : std::string_view("\0", 1))
      if (rank_in(part, side, split) != std::string_view::npos)
        return std::string(part.name) + (side ? std::string(".") + side : "");
  return "";
}

std::vector<NodePair> pair_nodes(const std::vector<std::string>& joints,
                                 const std::vector<std::string>& nodes,
                                 const std::vector<NodePair>& given) {
  Pairing pairing(joints.size(), nodes.size(), given);

  // Names that are the same need no knowledge of bodies.
  std::map<std::string, Index> node_of;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!pairing.node_taken()[n]) node_of.emplace(plain_name(nodes[n]), static_cast<Index>(n));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto found = node_of.find(plain_name(joints[j]));
    if (found == node_of.end() || found->first.empty() || pairing.joint_taken()[j]) continue;
    if (!pairing.node_taken()[at(found->second)])
      pairing.add({static_cast<Index>(j), found->second});
  }

  // The others are paired where both are the same part of a body.
  const std::vector<Sided> sided_joints = split_all(joints), sided_nodes = split_all(nodes);
  for (const Part& part : kParts)
    for (const char side : part.has_side ? std::string_view("lr") : std::string_view("\0", 1)) {
      const Index joint = find_part(part, side, sided_joints, pairing.joint_taken());
      const Index node = find_part(part, side, sided_nodes, pairing.node_taken());
      if (joint != kNone && node != kNone) pairing.add({joint, node});
    }
  return pairing.take();
}

}  // namespace icloth
