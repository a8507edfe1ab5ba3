#pragma once

#include "distributed/support/comm.hpp"
#include "isotherm/spectral/distributed.hpp"

namespace isotherm::spectral::distributed {

struct Session::State {
  detail::Comm comm;
  detail::Comm ending;  // beside the computation, for agree_on_end()
};

}  // namespace isotherm::spectral::distributed
