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

}  // namespace isotherm::detail
