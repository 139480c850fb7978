// Stands in for Thrust's header.
#pragma once

namespace thrust {

/// Element i is first + i.
template <class T>
struct counting_iterator {
  T first;
  explicit counting_iterator(T first_) : first(first_) {}
  T operator[](T i) const { return static_cast<T>(first + i); }
};

}  // namespace thrust
