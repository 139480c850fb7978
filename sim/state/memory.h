// Everything that a step goes on from: two simulators of one scene that hold equal memories, with
// equal parameters, make equal steps, bit for bit. Snapshots, the history, going back after a
// refused step and checkpoints are copies of it.
//
// A new thing to remember gets a member in MemoryOf and a line in for_each_part; copies, byte
// counts, checks and serialisation follow from there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/parallel/platform.h"
#include "kernels/vec.h"
#include "sim/scene/input.h"

namespace icloth {

/// Tangential force that a pair held at the end of a step, with which it goes on
/// (kernels/contact.h).
template <class Real>
struct HeldForceOf {
  std::uint64_t key = 0;  ///< of the pair
  Vec3<Real> force;       ///< [N]
  Index stuck = 0;        ///< 0: the pair was sliding
};

/// A cloth vertex and a body that do not see each other, because bodies leave the cloth no room,
/// until the vertex is outside again (sim/collision/pinch.h).
struct LetGo {
  Index vertex = 0;
  Index body = 0;  ///< number of the object in the world
  Index side = 1;  ///< +1: outside is where the normals of the body's faces point, −1: opposite
};

/// How far a stitched pair of an open seam has come (sim/mechanics/seam_springs.h).
template <class Real>
struct StitchStateOf {
  Real clock = 0;    ///< time for which it has been closing [s]; −1: it waits for a hand
  Real mark = 0;     ///< distance when it last came 1 % nearer [m]
  Index age = 0;     ///< steps at full pull since then, and 1; 0: it was not looked at yet
  Index closed = 0;  ///< 1: it was closed once, and is held together since
};

/// A pair that comes no nearer for so many steps, pulled as strongly as it may be, is stuck.
inline constexpr Index kStuckSteps = 100;

/// Welding of a seam (sim/sewing_simulator.h).
struct SeamProgress {
  Index welded = 0;  ///< 0: open; else the place in the order in which seams were welded, from 1
  Index delay = 0;   ///< steps to wait after a weld that failed
  std::int64_t next = 0;  ///< step from which on welding is tried
};

/// Deformation of a face at which the friction of its yarns pulls nowhere
/// (kernels/yarn_friction.h).
struct FaceYarns {
  double curvature[3] = {};  ///< uu, uv, vv [1/m]
  double shear = 0;          ///< Green strain G_uv
};

/// Region in which the broad phase trusts its lists (sim/collision/broad_phase.h).
struct TrustedBox {
  float lo[3] = {}, hi[3] = {};  ///< [m]
};

/// A handle with the patch of cloth that it pulls. Radius and stiffness of the handle are those in
/// force.
struct HeldPatch : HeldHandle {
  Triangle corners{};             ///< vertices of the face that was hit
  std::vector<Index> vertices{};  ///< the patch
  std::vector<double> share{};    ///< of the stiffness, sums to 1 (patch)
  std::vector<Vec3d> offset{};    ///< from the hit point at the grab [m] (patch)
  Vec3d followed{};               ///< the target, limited in speed [m]
  Vec3d pulled_to{};              ///< the same, limited in force too [m]
  double saturation = 0;          ///< pull / largest allowed pull, 0…1
};

/// The last step as a two-step integrator needs it (sim/mechanics/time_rule.h).
template <class Storage>
struct PastOf {
  template <class T>
  using List = typename Storage::template List<T>;

  List<Vec3<typename Storage::Real>> motion;  ///< x0 − x₋₁ [m] (cloth_vertices)
  List<Vec3<typename Storage::Real>> change;  ///< v0 − v₋₁ [m/s] (cloth_vertices); 0 where the
                                              ///< vertex touched something
  double dt = 0;  ///< of that step [s]; 0: there is no past

  void forget() {
    dt = 0;
    motion.resize(0);
    change.resize(0);
  }
};

/// `Storage` says where lists live and in which precision: on the host in doubles (Snapshot), or
/// where a build computes (sim/state/device_memory.h).
template <class Storage>
struct MemoryOf {
  using Real = typename Storage::Real;
  template <class T>
  using List = typename Storage::template List<T>;

  std::int64_t step = 0;  ///< steps made so far
  double time = 0;        ///< [s]
  /// How far the bodies are behind it, because they were slowed down (bodies.speed) [s].
  double body_lag = 0;

  List<Vec3<Real>> x1;  ///< positions at the end of the last step, cloths first [m] (vertices)
  List<Vec3<Real>> v;   ///< velocities [m/s] (vertices)

  List<HeldForceOf<Real>> held;  ///< friction of the pairs in contact, sorted by key
  PastOf<Storage> past;

  /// Anchors of the friction between yarns (cloth_faces); empty without yarn friction.
  List<typename Storage::YarnAnchor> yarns;
  bool yarns_bend = false;  ///< the anchors know curvatures, not shear alone

  /// Smallest gap of each vertex at time 0, at most the thickness [m] (cloth_vertices); empty when
  /// nothing started closer than that, and once the repulsion has its whole thickness.
  List<Real> start_gap;

  /// Regions of the start and of the end of paths for which the broad phase has all candidate pairs
  /// (vertices each); empty: none. The pairs in contact depend on them: those just beyond the
  /// thickness are in the lists or not.
  List<typename Storage::Box> trusted_start, trusted_end;
  bool trusted_complete = false;  ///< the lists hold all pairs of the boxes, not the dirty alone

  /// Where the cloth was when it was last seen to move [m] (cloth_vertices), and when [s]
  /// (sim/state/stillness.h); empty without step.sleep.
  List<Vec3<Real>> still_x;
  double still_since = 0;

  List<LetGo> let_go;  ///< sorted by vertex and body, mostly empty

  List<StitchStateOf<Real>> stitches;  ///< of the pairs of open seams

  std::vector<SeamProgress> seams;  ///< one for each seam of the scene

  std::vector<HeldPatch> hands;  ///< in the order in which they grabbed

  void copy_from(const MemoryOf& other);
};

/// How long a list may be.
enum class Extent { single, vertices, cloth_vertices, cloth_faces, stitches, seams, any };

struct MemoryPart {
  const char* name;
  Extent extent;
  bool may_be_empty = false;
};

/// visit(part, member of the first memory, member of the second …) for everything that a memory
/// holds. This is the only list of it.
template <class Visit, class... Memory>
void for_each_part(const Visit& visit, Memory&... m) {
  // The time, the positions and the velocities are those that the last step reached.
  visit(MemoryPart{"step", Extent::single}, m.step...);
  visit(MemoryPart{"time", Extent::single}, m.time...);
  visit(MemoryPart{"body_lag", Extent::single}, m.body_lag...);
  visit(MemoryPart{"x1", Extent::vertices}, m.x1...);
  visit(MemoryPart{"v", Extent::vertices}, m.v...);

  // The friction of contacts goes on, and integrators of two steps need the step before.
  visit(MemoryPart{"held", Extent::any}, m.held...);
  visit(MemoryPart{"past.motion", Extent::cloth_vertices, true}, m.past.motion...);
  visit(MemoryPart{"past.change", Extent::cloth_vertices, true}, m.past.change...);
  visit(MemoryPart{"past.dt", Extent::single}, m.past.dt...);

  // The yarns' anchors and the gaps with which layers started also go on from step to step.
  visit(MemoryPart{"yarns", Extent::cloth_faces, true}, m.yarns...);
  visit(MemoryPart{"yarns_bend", Extent::single}, m.yarns_bend...);
  visit(MemoryPart{"start_gap", Extent::cloth_vertices, true}, m.start_gap...);

  // Open seams go on closing.
  visit(MemoryPart{"stitches", Extent::stitches}, m.stitches...);
  visit(MemoryPart{"seams", Extent::seams}, m.seams...);

  // The rest are the boxes of the candidate lists, how long the cloth has been still, the vertices
  // let go from bodies, and the hands.
  visit(MemoryPart{"trusted_start", Extent::vertices, true}, m.trusted_start...);
  visit(MemoryPart{"trusted_end", Extent::vertices, true}, m.trusted_end...);
  visit(MemoryPart{"trusted_complete", Extent::single}, m.trusted_complete...);
  visit(MemoryPart{"still_x", Extent::cloth_vertices, true}, m.still_x...);
  visit(MemoryPart{"still_since", Extent::single}, m.still_since...);
  visit(MemoryPart{"let_go", Extent::any}, m.let_go...);
  visit(MemoryPart{"hands", Extent::any}, m.hands...);
}

template <class Storage>
void MemoryOf<Storage>::copy_from(const MemoryOf& other) {
  const auto copy = [](const MemoryPart&, auto& to, const auto& from) {
    if constexpr (requires { to.copy_from(from); })
      to.copy_from(from);
    else
      to = from;
  };
  for_each_part(copy, *this, other);
}

struct OnHost {
  template <class T>
  using List = std::vector<T>;
  using Real = double;
  using YarnAnchor = FaceYarns;
  using Box = TrustedBox;
};

/// A memory on the host, the same for every build. Single precision fits into it without loss.
using Snapshot = MemoryOf<OnHost>;

/// Memory that a snapshot takes, what its lists hold included [B].
std::size_t memory_bytes(const Snapshot& snapshot);

/// Counts of a scene, by which the lists of a memory are checked.
struct MemoryShape {
  Index vertices = 0, cloth_vertices = 0, cloth_faces = 0;
  Index objects = 0;  ///< cloths and bodies
  Index stitches = 0, seams = 0;
};

/// Throws std::invalid_argument, in one line, when the lists are not as long as the scene needs
/// them, or a hand or what is let go names vertices or bodies that there are not.
void check_memory(const Snapshot& snapshot, const MemoryShape& shape);

/// A snapshot as bytes: version, length and check sum, then all parts; equal snapshots give equal
/// bytes.
std::vector<std::byte> memory_to_bytes(const Snapshot& snapshot);

/// Reads a snapshot from such bytes. They may come from anywhere: lengths are checked before memory
/// is taken, and an InputError that begins with `source`, the name of the file, says what is wrong.
Snapshot memory_from_bytes(std::span<const std::byte> bytes, const std::string& source);

}  // namespace icloth
