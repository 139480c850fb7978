#include "sim/state/device_memory.h"

#include <algorithm>
#include <iterator>

namespace icloth::ICLOTH_BUILD {
namespace {

Real real(double value) { return static_cast<Real>(value); }

// One element from the device's form to the host's and back.

void assign(double& to, Real from) { to = static_cast<double>(from); }
void assign(Vec3d& to, const Vec3r& from) { to = convert<double>(from); }
void assign(HeldForceOf<double>& to, const HeldForce& from) {
  to = {from.key, convert<double>(from.force), from.stuck};
}
void assign(LetGo& to, const LetGo& from) { to = from; }
void assign(StitchStateOf<double>& to, const StitchStateOf<Real>& from) {
  to = {static_cast<double>(from.clock), static_cast<double>(from.mark), from.age, from.closed};
}
void assign(FaceYarns& to, const YarnAnchor& from) {
  assign(to.curvature[0], from.curvature.uu);
  assign(to.curvature[1], from.curvature.uv);
  assign(to.curvature[2], from.curvature.vv);
  assign(to.shear, from.shear);
}
template <class To, class From>
void assign_box(To& to, const From& from) {
  std::copy(std::begin(from.lo), std::end(from.lo), to.lo);
  std::copy(std::begin(from.hi), std::end(from.hi), to.hi);
}
void assign(TrustedBox& to, const Box& from) { assign_box(to, from); }

void assign_real(Real& to, double from) { to = real(from); }
void assign_real(Vec3r& to, const Vec3d& from) { to = convert<Real>(from); }
void assign_real(HeldForce& to, const HeldForceOf<double>& from) {
  to = {from.key, convert<Real>(from.force), from.stuck};
}
void assign_real(LetGo& to, const LetGo& from) { to = from; }
void assign_real(StitchStateOf<Real>& to, const StitchStateOf<double>& from) {
  to = {real(from.clock), real(from.mark), from.age, from.closed};
}
void assign_real(YarnAnchor& to, const FaceYarns& from) {
  to = {{real(from.curvature[0]), real(from.curvature[1]), real(from.curvature[2])},
        real(from.shear)};
}
void assign_real(Box& to, const TrustedBox& from) { assign_box(to, from); }

struct Download {
  template <class To, class From>
  void operator()(const MemoryPart&, std::vector<To>& to, const Array<From>& from) const {
    const std::vector<From> host = from.download();
    to.resize(host.size());
    for (std::size_t i = 0; i < host.size(); ++i) assign(to[i], host[i]);
  }
  template <class T>
  void operator()(const MemoryPart&, T& to, const T& from) const {
    to = from;
  }
};

struct Upload {
  template <class To, class From>
  void operator()(const MemoryPart&, Array<To>& to, const std::vector<From>& from) const {
    std::vector<To> host(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) assign_real(host[i], from[i]);
    to.upload(host);
  }
  template <class T>
  void operator()(const MemoryPart&, T& to, const T& from) const {
    to = from;
  }
};

}  // namespace

Snapshot download(const Memory& memory) {
  Snapshot snapshot;
  for_each_part(Download{}, snapshot, memory);
  return snapshot;
}

void upload(const Snapshot& snapshot, Memory& memory) { for_each_part(Upload{}, memory, snapshot); }

}  // namespace icloth::ICLOTH_BUILD
