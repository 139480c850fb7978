#include "sim/scene/scene_motion.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kernels/index.h"
#include "sim/bodies/retarget.h"
#include "sim/files/body_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::size_t kMostNamed = 6;
constexpr std::size_t kMostPlaces = 100'000'000;  // of nodes, over all frames

/// "a, b and 3 more" of the names that are not empty.
std::string some_names(const std::vector<std::string>& names) {
  std::vector<std::string> shown;
  for (const std::string& name : names)
    if (!name.empty()) shown.push_back(in_quotes(name));
  return first_items(shown, kMostNamed);
}

/// The number of a name, exactly as it is in the file.
Index find_name(const JsonValue& value, const std::string& name,
                const std::vector<std::string>& names, const std::string& what) {
  const auto found = std::ranges::find(names, name);
  if (name.empty() || found == names.end()) value.refuse(what + ": " + some_names(names));
  return static_cast<Index>(found - names.begin());
}

/// The pairs that the scene gives: {"joint of the motion": "bone of the body"}.
std::vector<NodePair> parse_bones(JsonObject& object, const Rig& motion, const std::string& file,
                                  const Rig& rig, const std::string& body_file) {
  std::vector<NodePair> pairs;
  if (!object.has("bones")) return pairs;
  const JsonValue table = object["bones"];
  if (!table.is_object()) table.refuse("an object {\"joint of the motion\": \"bone of the body\"}");
  for (const auto& [joint, bone] : table.json().items()) {
    const JsonValue value(bone, table.where() + "." + excerpt(joint));
    const NodePair pair = {find_name(JsonValue(nlohmann::json(joint), table.where()), joint,
                                     motion.names, "a joint of " + file),
                           find_name(value, value.text(), rig.names, "a bone of " + body_file)};
    if (std::ranges::find(pairs, pair.node, &NodePair::node) != pairs.end())
      value.refuse("a bone that has no other joint yet");
    pairs.push_back(pair);
  }
  return pairs;
}

/// Joints that move something in their own skeleton and nothing here.
void note_without_partner(const Rig& motion, const std::vector<NodePair>& pairs,
                          const std::string& file, const MovedBody& body,
                          const SceneFolder& folder) {
  std::vector<std::string> alone;
  for (std::size_t j = 0; j < motion.names.size(); ++j)
    if (std::ranges::find(pairs, static_cast<Index>(j), &NodePair::joint) == pairs.end() &&
        !motion.names[j].empty())
      alone.push_back(motion.names[j]);
  if (alone.empty()) return;
  folder.note(body.name + ": joints of " + file + " without a partner among the bones of " +
              body.file + ": " + std::to_string(alone.size()) + " (" + some_names(alone) +
              "); \"bones\" can give them one");
}

}  // namespace

Clip clip_of_motion(JsonObject& object, const SceneFolder& folder, const MovedBody& body,
                    const Rig& rig) {
  const JsonValue key = object["animation"];
  const std::string file = shown_path(key.text());
  if (rig.empty()) key.refuse("a body with bones to play it, which " + body.file + " is not");
  const Rig motion = read_motion(folder.find(key));

  // Pairs by the names of the scene, and where it gives none, by those that are alike.
  const std::vector<NodePair> pairs =
      pair_nodes(motion.names, rig.names, parse_bones(object, motion, file, rig, body.file));
  if (!root_pair(motion, pairs))
    key.refuse(
        "at least three joints, the hips above the others among them, with names like the "
        "bones of " +
        body.file + " or in \"bones\": only " + std::to_string(pairs.size()) + " of its joints (" +
        some_names(motion.names) + ") are like its bones (" + some_names(rig.names) + ")");
  std::size_t frames = 1;
  for (const NodeChannel& channel : motion.clips[0].channels)
    frames = std::max({frames, channel.rotation.size(), channel.translation.size()});
  if (frames > kMostPlaces / rig.parent.size())
    key.refuse("at most " + std::to_string(kMostPlaces / rig.parent.size()) + " frames for the " +
               std::to_string(rig.parent.size()) + " nodes of " + body.file + ", not " +
               std::to_string(frames));
  note_without_partner(motion, pairs, file, body, folder);

  // Whatever was done to the motion beyond its names is said as well.
  Retargeted result = retarget(motion, rig, pairs, body.up);
  if (result.turned)
    folder.note(body.name + ": the axes of " + file + " are turned to those of " + body.file);
  if (result.moved > 0)
    folder.note(body.name + ": " + file + " starts " + rounded_text(result.moved) +
                " (in the units of " + body.file +
                ") away from its rest pose: the body starts at its own place instead");
  return std::move(result.clip);
}

}  // namespace icloth
