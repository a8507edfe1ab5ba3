# Fails unless every header isotherm/<layer>.hpp opens with the program that consumer/ has for
# it and includes every header of the layer, and the README has the programs word for word.
#
# usage: cmake -DROOT=<project root> -P check_front_doors.cmake

cmake_minimum_required(VERSION 3.25)

set(layers slam spectral network geometry)
set(programs prune edges localize neighbours)
set(in_readme prune edges localize)

file(READ ${ROOT}/README.md readme)
set(faults "")
foreach(layer program IN ZIP_LISTS layers programs)
  file(READ ${ROOT}/tests/package/consumer/${program}.cpp text)
  if(program IN_LIST in_readme)
    string(FIND "${readme}" "```cpp\n${text}```" place)
    if(place EQUAL -1)
      string(APPEND faults "\nREADME.md does not have ${program}.cpp as it is tested")
    endif()
  endif()

  file(READ ${ROOT}/${layer}/include/isotherm/${layer}.hpp header)
  string(REGEX REPLACE "\n$" "" comment "${text}")
  string(REPLACE "\n" "\n//     " comment "//     ${comment}")
  string(REPLACE "//     \n" "//\n" comment "${comment}")
  string(FIND "${header}" "\n${comment}\n#pragma once\n" place)
  if(place EQUAL -1)
    string(APPEND faults "\nisotherm/${layer}.hpp does not open with ${program}.cpp")
  endif()

  file(GLOB_RECURSE parts RELATIVE ${ROOT}/${layer}/include
    ${ROOT}/${layer}/include/isotherm/${layer}/*.hpp)
  # A library of its own, which most builds do not have.
  list(REMOVE_ITEM parts isotherm/spectral/distributed.hpp)
  foreach(part IN LISTS parts)
    string(FIND "${header}" "\n#include \"${part}\"\n" place)
    if(place EQUAL -1)
      string(APPEND faults "\nisotherm/${layer}.hpp does not include ${part}")
    endif()
  endforeach()
endforeach()
if(faults)
  message(FATAL_ERROR "${faults}")
endif()
