#include "isotherm/base/parallel.hpp"

#include <algorithm>

#include "../parallel.hpp"

namespace isotherm {

void parallel_for(std::int64_t count, int threads, const ProgressCallback& progress,
                  std::string_view stage, const std::function<void(std::int64_t)>& body) {
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  const auto grain = static_cast<std::size_t>(std::max<std::int64_t>(1, count / 256));
  const auto no_workspace = [] { return 0; };
  spectral::detail::parallel_for(count, grain, threads, progress, stage, no_workspace,
                                 [&body](int, std::int64_t index) { body(index); });
}

}  // namespace isotherm
