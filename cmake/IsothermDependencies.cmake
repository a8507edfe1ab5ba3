# What the libraries are built with, found once for all layers. What only the command, the
# tests or the benchmarks need is found there.

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# Headers only: quantiles of probability distributions, planarity.
find_package(Boost 1.74 REQUIRED)
find_package(TBB REQUIRED)
find_package(ZLIB REQUIRED)
find_package(FastFloat REQUIRED)
find_package(CHOLMOD REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(nanoflann REQUIRED)
find_package(Spectra REQUIRED)
if(ISOTHERM_MPI)
  find_package(MPI REQUIRED COMPONENTS CXX)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET PETSc>=3.18 SLEPc>=3.18)
endif()
