// Sets of numbers that grow together.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace icloth {

/// Sets that can be united; at first each number is one by itself. The smallest member stands for
/// its set, so the outcome does not depend on the order of unions.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::size_t i, std::size_t j) {
    const std::size_t a = find(i), b = find(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace icloth
