#pragma once

namespace isotherm::apps {

/// Keeps the calling thread's OpenMP regions, in libraries that have any, to that thread.
///
/// CHOLMOD opens four threads for pieces of work of microseconds, whatever `--threads` says;
/// they spin between two of them, a fifth of all CPU time on a large graph. The work that
/// is worth dividing is divided elsewhere. Does nothing where no OpenMP is loaded.
void keep_openmp_serial();

}  // namespace isotherm::apps
