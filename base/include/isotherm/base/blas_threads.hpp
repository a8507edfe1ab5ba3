#pragma once

namespace isotherm::detail {

/// Whether functions of the BLAS that the program is linked with may be called from several
/// threads at a time. OpenBLAS built without threads, as Debian's `libopenblas0-serial`, takes the
/// buffers of its products without a lock: two threads can get one buffer, and one product in a
/// hundred is wrong. Without threads is also what OpenBLAS built with `USE_LOCKING` calls itself.
///
/// The first call has an OpenBLAS that has threads use one a call, for the whole program: we run
/// several calls at a time instead, and results are the same bytes however many cores there are.
/// So it comes before the first use of the BLAS.
bool blas_serves_threads();

/// While it lives, what a library does with OpenMP on this thread it does on this thread alone.
/// CHOLMOD as Debian builds it asks for four threads for every front, whatever `OMP_NUM_THREADS`
/// says; where each of many small maps is factorised, a sixth of all time went into waking them.
class SequentialOpenMp {
 public:
  SequentialOpenMp();
  SequentialOpenMp(const SequentialOpenMp&) = delete;
  SequentialOpenMp& operator=(const SequentialOpenMp&) = delete;
  ~SequentialOpenMp();

 private:
  static void allow(int levels);

  int levels_ = 1;  // of parallel regions in each other, before
};

}  // namespace isotherm::detail
