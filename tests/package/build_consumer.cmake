# Installs BUILD_DIR below SCRATCH, then configures, builds and runs the programs of
# SOURCE_DIR against that install tree only.

cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${SCRATCH} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${SCRATCH}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(build/inspector make)
run(build/prune plane.g2o plane-pruned.g2o plane.csv)
run(build/prune space.g2o space-pruned.g2o space.csv)
run(build/edges graph.csv kept.csv)
run(build/neighbours points.csv neighbours.csv)
run(build/localize ranges.csv anchors.csv positions.csv)
run(build/inspector check)
file(REMOVE_RECURSE ${SCRATCH})
