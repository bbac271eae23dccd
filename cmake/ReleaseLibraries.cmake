# Those of scripts/build-libraries, which programs and shared libraries take in alike: a program of a release needs no more
# than the C and C++ libraries, a shared library OpenMP's beside.

# twinmap_static(<name> [<what it needs>...]): the static library libNAME.a as the target static_NAME
function(twinmap_static name)
  add_library(static_${name} STATIC IMPORTED)
  set_target_properties(static_${name} PROPERTIES
    IMPORTED_LOCATION "${TWINMAP_LIBRARIES}/lib/lib${name}.a" INTERFACE_LINK_LIBRARIES "${ARGN}")
endfunction()
twinmap_static(streams)
twinmap_static(z)
twinmap_static(aec)
twinmap_static(sz static_aec)
twinmap_static(hdf5 static_sz static_z m ${CMAKE_DL_LIBS})
twinmap_static(matio static_hdf5 static_z static_streams)
twinmap_static(expat static_streams)
twinmap_static(udunits2 static_expat static_streams m)
twinmap_static(zip static_z)
twinmap_static(xxhash)
twinmap_static(pugixml)

# twinmap_alias(<target> <static library> [<its headers>]): under the name that rooms link
function(twinmap_alias target library)
  add_library(${target} INTERFACE IMPORTED)
  set_target_properties(${target} PROPERTIES
    INTERFACE_LINK_LIBRARIES static_${library} INTERFACE_INCLUDE_DIRECTORIES "${ARGN}")
endfunction()
twinmap_alias(twinmap_hdf5_library hdf5 ${HDF5_C_INCLUDE_DIRS})
twinmap_alias(matio matio "${MATIO_INCLUDE_DIR}")
twinmap_alias(udunits2 udunits2)
twinmap_alias(PkgConfig::xxhash xxhash)
twinmap_alias(PkgConfig::libzip zip "${TWINMAP_LIBRARIES}/include")
twinmap_alias(pugixml::pugixml pugixml)

# A program takes in OpenMP too. A shared library cannot: the static one is compiled for programs.
string(REGEX REPLACE "\\.so$" ".a" TWINMAP_STATIC_OPENMP "${OpenMP_gomp_LIBRARY}")
get_target_property(openmp OpenMP::OpenMP_CXX INTERFACE_LINK_LIBRARIES)
string(REGEX REPLACE "[^;]*libgomp\\.so" "$<IF:${TWINMAP_IN_PROGRAM},${TWINMAP_STATIC_OPENMP},\\0>" openmp "${openmp}")
set_target_properties(OpenMP::OpenMP_CXX PROPERTIES INTERFACE_LINK_LIBRARIES "${openmp}")

# The library of MQTT wants OpenSSL's: builds from the source alone have it.
set(TWINMAP_HAS_MQTT OFF)
