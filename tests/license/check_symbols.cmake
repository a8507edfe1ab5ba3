# usage: cmake -DNM=nm -DBINARY=program -P check_symbols.cmake
# Fails if the program has a symbol of CHOLMOD's Supernodal, Modify or MatrixOps module.
execute_process(COMMAND ${NM} -D ${BINARY} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES "cholmod_factorize")
  message(FATAL_ERROR "${BINARY} shows no symbol of CHOLMOD at all")
endif()
string(REGEX MATCHALL
  "cholmod_(l_)?(super[a-z0-9_]*|updown[a-z0-9_]*|row(add|del)[a-z0-9_]*|sdmult|ssmult|norm_[a-z]+|scale|drop|horzcat|vertcat|submatrix|symmetry)"
  found "${symbols}")
if(found)
  message(FATAL_ERROR "${BINARY} has symbols of CHOLMOD's GPL modules: ${found}")
endif()
