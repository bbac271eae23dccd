# Every package comes from the distribution; scripts/install-dependencies lists them by name. Releases contain most of them
# as static libraries (cmake/ReleaseLibraries.cmake), so that they need none of their system.
set(TWINMAP_LIBRARIES "" CACHE PATH
  "Static libraries to build with, as scripts/build-libraries makes them; empty: those of the distribution")
if(TWINMAP_LIBRARIES)
  if(NOT EXISTS "${TWINMAP_LIBRARIES}/state")
    message(FATAL_ERROR "TWINMAP_LIBRARIES: '${TWINMAP_LIBRARIES}' has no libraries; scripts/build-libraries makes them")
  endif()
  list(PREPEND CMAKE_PREFIX_PATH "${TWINMAP_LIBRARIES}")
endif()
set(TWINMAP_IN_PROGRAM "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>")
find_package(Eigen3 3.4 REQUIRED)
find_package(NLopt REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
# Threads are twinmap's own, outside Eigen: how Eigen cuts a product depends on their number.
set_property(TARGET OpenMP::OpenMP_CXX APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS EIGEN_DONT_PARALLELIZE)
find_package(fmt REQUIRED)
link_libraries(OpenMP::OpenMP_CXX fmt::fmt) # every target, as precompiled headers need the same flags
find_package(Boost 1.74 REQUIRED)
find_package(Simbody 3.7 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
set(HDF5_USE_STATIC_LIBRARIES ON)
find_package(HDF5 REQUIRED COMPONENTS C)
find_path(MATIO_INCLUDE_DIR matio.h REQUIRED)
if(TWINMAP_LIBRARIES)
  include(ReleaseLibraries)
else()
  include(DistributionLibraries)
endif()

# The Python package is for the distribution's Python; another one as Python3_EXECUTABLE.
set(TWINMAP_BUILD_PYTHON AUTO CACHE STRING "Build the Python package: ON, OFF, or AUTO: where Python's headers and nanobind are")
set(TWINMAP_HAS_PYTHON OFF)
if(NOT TWINMAP_BUILD_PYTHON STREQUAL "OFF" AND NOT TWINMAP_SANITIZE)
  include(Nanobind)
endif()
