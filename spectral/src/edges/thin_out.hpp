#pragma once

#include <cstddef>
#include <vector>

namespace isotherm::spectral::detail {

/// Every so manieth, so that not much more than `about` are left: enough for a rate.
template <class T>
std::vector<T> thin_out(const std::vector<T>& all, std::size_t about = 5000) {
  const std::size_t stride = all.size() / about + 1;
  std::vector<T> thin;
  for (std::size_t k = 0; k < all.size(); k += stride) thin.push_back(all[k]);
  return thin;
}

}  // namespace isotherm::spectral::detail
