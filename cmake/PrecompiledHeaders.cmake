# Headers that most translation units include are parsed once for all of them. GCC and clang take a precompiled header
# only where flags and definitions agree, so these are the same for every target (cmake/CompileOptions.cmake).
# What a file uses it still includes itself: CMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without.
set(TWINMAP_COMMON_HEADERS
  <kernels/linalg/eigen_products.hpp> <Eigen/Core> <Eigen/SparseCore> <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstring> <filesystem> <functional> <limits> <map>
  <memory> <mutex> <numeric> <optional> <set> <sstream> <stdexcept> <string> <string_view> <unordered_map> <utility>
  <variant> <vector> <fmt/core.h>)

# twinmap_precompile(<name> [HEADERS <headers...>] [LIBRARIES <targets...>] [OPTIONS <options...>]): the common headers and
# more of libraries, compiled with options, for targets that ask for both by twinmap_use_precompiled(<target> <name>).
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
function(twinmap_precompile name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
  set(headers twinmap_precompiled_${name})
  add_library(${headers} OBJECT EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_include_directories(${headers} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${headers} PRIVATE Eigen3::Eigen ${ARG_LIBRARIES})
  target_compile_options(${headers} PUBLIC ${ARG_OPTIONS})
  target_precompile_headers(${headers} PRIVATE ${TWINMAP_COMMON_HEADERS} ${ARG_HEADERS})
endfunction()

function(twinmap_use_precompiled target name)
  set(headers twinmap_precompiled_${name})
  target_precompile_headers(${target} REUSE_FROM ${headers})
  target_compile_options(${target} PRIVATE $<TARGET_PROPERTY:${headers},INTERFACE_COMPILE_OPTIONS>)
  if(NOT target STREQUAL "twinmap_linalg")
    target_link_libraries(${target} PRIVATE twinmap_linalg) # what eigen_products.hpp declares
  endif()
endfunction()

# Code that organises rather than computes: a third less time to compile than with -O3, and no slower where it counts.
# Releases, which have it three times, take a fifth more time to compile and are a quarter smaller.
set(TWINMAP_LIGHT $<$<CONFIG:Release>:$<IF:$<BOOL:${TWINMAP_LIBRARIES}>,-Os,-O1>>)
set(TWINMAP_SPEC <framework/experiment/experiment_spec.hpp>) # what most of the framework includes

twinmap_precompile(common)
twinmap_precompile(framework HEADERS ${TWINMAP_SPEC})
twinmap_precompile(light HEADERS ${TWINMAP_SPEC} OPTIONS ${TWINMAP_LIGHT})
