// A run that was interrupted, and what it goes on from.
#pragma once

#include <cstdint>
#include <string>

#include "sim/scene/input.h"
#include "sim/state/memory.h"

namespace icloth {

/// The state after a number of steps, with the input that led to it: one step of the recording for
/// each of them, whose final hash is that of the state.
struct Checkpoint {
  Recording recording;
  std::uint64_t start_hash = 0;  ///< of the state at time 0, by which its scene is known again
  Snapshot state;

  std::int64_t steps() const { return static_cast<std::int64_t>(recording.steps.size()); }
};

/// Writes a temporary file beside `path` and renames it, so that an older checkpoint stays until
/// the new one is whole. Throws InputError where the place cannot be written.
void save_checkpoint(const Checkpoint& checkpoint, const std::string& path);

/// Throws InputError naming the file and what is wrong: it may come from anywhere, and lengths are
/// checked before memory is taken. Whether it fits the scene is for Simulator::restore to say.
Checkpoint load_checkpoint(const std::string& path);

}  // namespace icloth
