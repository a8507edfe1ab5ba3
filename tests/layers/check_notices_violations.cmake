# Plants one violation at a time in a copy of the tree's headers and expects the
# layer check to name it.

cmake_minimum_required(VERSION 3.25)

function(expect_violation file include)
  file(REMOVE_RECURSE ${SCRATCH})
  file(MAKE_DIRECTORY ${SCRATCH})
  foreach(layer base spectral geometry network slam)
    file(COPY ${ROOT}/${layer} DESTINATION ${SCRATCH})
  endforeach()
  file(WRITE ${SCRATCH}/${file} "#include <${include}>\n")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH} -P ${ROOT}/tests/layers/check_layers.cmake
    RESULT_VARIABLE code ERROR_VARIABLE errors OUTPUT_QUIET)
  if(code EQUAL 0 OR NOT errors MATCHES "includes[ \n]+${include}")
    message(FATAL_ERROR "${file} including ${include} went unnoticed: ${errors}")
  endif()
endfunction()

expect_violation(spectral/include/isotherm/spectral/planted.hpp isotherm/slam/graph/pose.hpp)
expect_violation(spectral/src/planted.cpp isotherm/geometry/curves/polyline.hpp)
expect_violation(geometry/src/planted.cpp isotherm/slam/graph/pose.hpp)
expect_violation(base/src/planted.cpp isotherm/spectral/types.hpp)
expect_violation(network/src/planted.cpp isotherm/slam/graph/pose.hpp)
expect_violation(slam/include/isotherm/slam/planted.hpp nanoflann.hpp)
expect_violation(spectral/src/planted.cpp CGAL/Point_2.h)
file(REMOVE_RECURSE ${SCRATCH})
