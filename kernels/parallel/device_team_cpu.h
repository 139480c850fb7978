// A team of all threads of the CPU, included by kernels/parallel/parallel_cpu.h. Its members are
// documented in kernels/parallel/parallel.h. One thread runs the problem and shares out the
// iterations of its loops.
#pragma once

namespace icloth::ICLOTH_BUILD {

class DeviceTeam {
 public:
  void barrier() const {}

  template <class Body>
  void for_each(Index n, const Body& body) const {
    detail::for_each_index(n, body);
  }
  template <class Body>
  void single(const Body& body) const {
    body();
  }
  template <class Body>
  void in_one_block(const Body& body) const {
    body(*this);
  }
  template <class T, class Body, class Op>
  T reduce(Index n, T identity, const Body& body, const Op& op) const {
    return detail::reduce_indices(n, identity, body, op);
  }
  template <class T>
  View<T> borrow(View<T> view) const {
    return view;
  }
  template <class T>
  void give_back(View<const T>, View<T>) const {}
};

template <class F>
void with_device_team(const char* name, Index, const F& f) {
  const ProfileScope scope(name);
  DeviceTeam team;
  f(team);
}

}  // namespace icloth::ICLOTH_BUILD
