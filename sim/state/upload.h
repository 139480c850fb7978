// From lists of the host to arrays of the device.
#pragma once

#include <vector>

#include "kernels/parallel/array.h"

namespace icloth::ICLOTH_BUILD {

/// Uploads a list after converting each of its elements.
template <class To, class From, class Convert>
void upload_as(Array<To>& array, const std::vector<From>& from, const Convert& to) {
  std::vector<To> host;
  host.reserve(from.size());
  for (const From& value : from) host.push_back(to(value));
  array.upload(host);
}

}  // namespace icloth::ICLOTH_BUILD
