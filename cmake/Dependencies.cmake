# Every package comes from the distribution; scripts/install-dependencies lists them by name.
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
# Static: Debian's shared HDF5 brings some thirty libraries of a network client, which twinmap would load at each start.
set(HDF5_USE_STATIC_LIBRARIES ON)
find_package(HDF5 REQUIRED COMPONENTS C)
find_path(MATIO_INCLUDE_DIR matio.h REQUIRED)
find_library(MATIO_LIBRARY libmatio.a REQUIRED) # with the same copy of HDF5
# Debian's static libraries are for programs alone, as their code cannot be moved: shared libraries take the shared ones.
find_library(HDF5_SHARED_LIBRARY hdf5_serial REQUIRED)
find_library(MATIO_SHARED_LIBRARY matio REQUIRED)
set(TWINMAP_IN_PROGRAM "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>")
add_library(twinmap_hdf5_library INTERFACE)
target_include_directories(twinmap_hdf5_library SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
target_link_libraries(twinmap_hdf5_library INTERFACE
  "$<IF:${TWINMAP_IN_PROGRAM},HDF5::HDF5,${HDF5_SHARED_LIBRARY}>")
add_library(matio_static STATIC IMPORTED)
set_target_properties(matio_static PROPERTIES
  IMPORTED_LOCATION "${MATIO_LIBRARY}" INTERFACE_LINK_LIBRARIES HDF5::HDF5)
add_library(matio INTERFACE)
target_include_directories(matio SYSTEM INTERFACE "${MATIO_INCLUDE_DIR}")
target_link_libraries(matio INTERFACE
  "$<IF:${TWINMAP_IN_PROGRAM},matio_static,${MATIO_SHARED_LIBRARY}>" twinmap_hdf5_library)
find_package(PkgConfig REQUIRED)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)
find_package(pugixml REQUIRED)
find_package(Threads REQUIRED)
# Measurements by MQTT, where the library is.
pkg_check_modules(mosquitto IMPORTED_TARGET libmosquitto)
set(TWINMAP_HAS_MQTT ${mosquitto_FOUND})

# The Python package is for the distribution's Python, where pybind11 is; another one as Python3_EXECUTABLE.
set(TWINMAP_BUILD_PYTHON AUTO CACHE STRING "Build the Python package: ON, OFF, or AUTO: where pybind11 is")
set(TWINMAP_HAS_PYTHON OFF)
if(NOT TWINMAP_BUILD_PYTHON STREQUAL "OFF" AND NOT TWINMAP_SANITIZE)
  if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python3_EXECUTABLE /usr/bin/python3)
  endif()
  set(PYBIND11_NOPYTHON ON) # its headers alone
  if(TWINMAP_BUILD_PYTHON STREQUAL "AUTO")
    find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
    find_package(pybind11 2.10 QUIET CONFIG)
  else()
    find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
    find_package(pybind11 2.10 REQUIRED CONFIG)
  endif()
  if(Python3_Development.Module_FOUND AND pybind11_FOUND)
    set(TWINMAP_HAS_PYTHON ON)
  endif()
endif()
