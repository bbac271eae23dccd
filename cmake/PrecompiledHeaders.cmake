# Headers that most translation units include are parsed once for all of them. GCC and clang take a precompiled header
# only where flags and definitions agree, so these are the same for every target (cmake/CompileOptions.cmake).
# What a file uses it still includes itself: CMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without.
set(TWINMAP_COMMON_HEADERS
  <kernels/linalg/eigen_products.hpp> <Eigen/Core> <Eigen/SparseCore> <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstring> <filesystem> <functional> <limits> <map>
  <memory> <mutex> <numeric> <optional> <set> <sstream> <stdexcept> <string> <string_view> <unordered_map> <utility>
  <variant> <vector> <fmt/format.h>)

# twinmap_precompile(<name> [HEADERS <headers...>] [LIBRARIES <targets...>]): the common headers and more of libraries,
# for targets that ask for them by twinmap_use_precompiled(<target> <name>).
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
function(twinmap_precompile name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  add_library(twinmap_precompiled_${name} OBJECT EXCLUDE_FROM_ALL "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_include_directories(twinmap_precompiled_${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(twinmap_precompiled_${name} PRIVATE Eigen3::Eigen ${ARG_LIBRARIES})
  target_precompile_headers(twinmap_precompiled_${name} PRIVATE ${TWINMAP_COMMON_HEADERS} ${ARG_HEADERS})
endfunction()

function(twinmap_use_precompiled target name)
  target_precompile_headers(${target} REUSE_FROM twinmap_precompiled_${name})
  if(NOT target STREQUAL "twinmap_linalg")
    target_link_libraries(${target} PRIVATE twinmap_linalg) # what eigen_products.hpp declares
  endif()
endfunction()

twinmap_precompile(common)
twinmap_precompile(simbody HEADERS <Simbody.h> LIBRARIES SimTKsimbody SimTKmath SimTKcommon)
