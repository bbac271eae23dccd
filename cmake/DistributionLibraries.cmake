# Those of the distribution, as it installs them.

# Static: Debian's shared HDF5 brings some thirty libraries of a network client, which twinmap would load at each start.
find_library(MATIO_LIBRARY libmatio.a REQUIRED) # with the same copy of HDF5
# Debian's static libraries are for programs alone, as their code cannot be moved: shared libraries take the shared ones.
find_library(HDF5_SHARED_LIBRARY hdf5_serial REQUIRED)
find_library(MATIO_SHARED_LIBRARY matio REQUIRED)
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
# Measurements by MQTT, where the library is.
pkg_check_modules(mosquitto IMPORTED_TARGET libmosquitto)
set(TWINMAP_HAS_MQTT ${mosquitto_FOUND})
