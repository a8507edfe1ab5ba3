# One way to define a library of ours, so that flags, include roots, install
# rules and the exported name are the same for every layer.

# Where CMAKE_UNITY_BUILD is on, the sources of a room, with all folders in it, are compiled as
# one: what they include and instantiate is then compiled once. They hence share one unnamed
# namespace.
function(isotherm_unite_by_room target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(NOT IS_ABSOLUTE "${source}")
      cmake_path(GET source PARENT_PATH folder)
      string(REGEX REPLACE "^src/" "" folder "${folder}")
      string(REGEX REPLACE "/.*" "" room "${folder}")
      string(MAKE_C_IDENTIFIER "in_${room}" group)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()

# Options every target of the project is compiled with; never exported.
function(isotherm_compile_options target)
  isotherm_unite_by_room(${target})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused -Wnull-dereference
    # Call sites name the options they set and leave the others at their defaults.
    -Wno-missing-field-initializers
    # Eigen 3.4 with GCC 12 triggers these in its own vectorised code.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-null-dereference>
    # A tenth less time: below a gigabyte GCC's heap is not searched for what it could free.
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)
  if(ISOTHERM_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(ISOTHERM_BUILD_FUZZERS)
    # Coverage counters, by which libFuzzer finds its way.
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  if(ISOTHERM_SANITIZE)
    target_compile_options(${target} PRIVATE
      -fsanitize=${ISOTHERM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${ISOTHERM_SANITIZE})
  endif()
endfunction()

# For commands and tests, which do little but call the libraries: a third less to compile.
function(isotherm_optimise_lightly target)
  target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O1>)
endfunction()

# isotherm_add_library(<layer> SOURCES ... PUBLIC ... PRIVATE ...)
# Defines isotherm_<layer> with the alias isotherm::<layer>.
function(isotherm_add_library layer)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target isotherm_${layer})
  add_library(${target} ${ARG_SOURCES})
  add_library(isotherm::${layer} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${layer}
    VERSION ${PROJECT_VERSION}
    POSITION_INDEPENDENT_CODE ON
    CXX_EXTENSIONS OFF)
  target_include_directories(${target}
    PUBLIC
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE
      ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  isotherm_compile_options(${target})
  install(TARGETS ${target} EXPORT isothermTargets)
  set(left_out "")
  if(NOT ISOTHERM_MPI)
    set(left_out PATTERN distributed.hpp EXCLUDE)
  endif()
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${left_out})
endfunction()
