# One set of flags for every translation unit: Eigen's alignment depends on the instruction set, and
# Simbody's class layout on NDEBUG. Debian's Simbody is built without NDEBUG, so no build type defines it
# here; EIGEN_NO_DEBUG removes Eigen's index checks from optimised builds instead, and assert() stays.
set(CMAKE_CXX_STANDARD 17) # Simbody 3.7's headers do not compile as C++20
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DEIGEN_NO_DEBUG")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g -DEIGEN_NO_DEBUG")

if(TWINMAP_NATIVE)
  add_compile_options(-march=native)
else()
  add_compile_options(-march=x86-64-v3)
endif()
# Code that can go into a shared library, as fast as in a program: nothing is exported that does not say so, and no
# function can be replaced by another of its name, so that all can be inlined. Written as options for programs and libraries
# alike (CMake's own property would give programs -fPIE), as precompiled headers need the same.
add_compile_options(-fPIC -fno-semantic-interposition -fvisibility=hidden
                    $<$<COMPILE_LANGUAGE:CXX>:-fvisibility-inlines-hidden>)
add_compile_options(-Wall -Wextra -Wpedantic
                    $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> $<$<COMPILE_LANGUAGE:CXX>:-Woverloaded-virtual>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # false alarms in GCC 12's own AVX-512 headers (GCC bug 105593)
  add_compile_options(-Wshadow -Wno-maybe-uninitialized -Wno-uninitialized)
  # the compiler's memory is collected from half a gigabyte on, not from 128 MB, which a precompiled header fills alone:
  # a tenth of the build
  add_compile_options("SHELL:--param ggc-min-heapsize=500000")
else()
  # clang's -Wshadow sees what earlier files of a batch have made visible; its -Wall asks for braces in braces
  add_compile_options(-Wno-missing-braces)
endif()
if(TWINMAP_REPRODUCIBLE)
  add_compile_options("-ffile-prefix-map=${PROJECT_SOURCE_DIR}=.")
endif()
if(TWINMAP_LIBRARIES)
  # Units are compiled in batches and taken in whole: a release keeps the functions that are called.
  add_compile_options(-ffunction-sections -fdata-sections)
  add_link_options(-Wl,--gc-sections)
endif()
if(TWINMAP_WARNINGS_AS_ERRORS)
  add_compile_options($<$<COMPILE_LANGUAGE:C,CXX>:-Werror>) # not assembly, whose compiler has no use for most options
endif()

add_link_options(-Wl,--as-needed) # a process loads only the libraries that it uses

set(TWINMAP_SANITIZE "" CACHE STRING "Sanitizers, as in -fsanitize=..., or empty")
if(TWINMAP_SANITIZE)
  # Left out are checks of pointers: what they find faults by itself (null, aligned vector loads) or is found by the
  # address sanitizer, and they would cost 40 per cent of the build.
  add_compile_options(-fsanitize=${TWINMAP_SANITIZE} -fno-sanitize=null,alignment,pointer-overflow,object-size,vptr,nonnull-attribute,returns-nonnull-attribute
                      -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${TWINMAP_SANITIZE})
endif()

# ccache hashes the precompiled header for each unit: a unit of 2.1 s of a processor takes 3.3 s the first time, 0.9 s again.
option(TWINMAP_CCACHE "Keep objects for other builds (ccache); a build from nothing takes half as long again" OFF)
if(TWINMAP_CCACHE)
  find_program(CCACHE_PROGRAM ccache REQUIRED)
  # what ccache asks for with precompiled headers
  set(CMAKE_CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE_PROGRAM}")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)
  else()
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
  endif()
endif()

# twinmap_add_library(<target> [SOURCES <files...>] [MORE <files...>] [PRECOMPILED <name>] [LIGHT <folders...>] [BATCH <files>]
# [PUBLIC <targets...>] [PRIVATE <targets...>]): a static library of all C++ files below its folder, or of SOURCES, and of
# MORE that are made elsewhere. Headers are included by their path from the project's root. PRECOMPILED as in
# cmake/PrecompiledHeaders.cmake, framework by default; LIGHT: folders that organise, in a library that computes; BATCH as in
# cmake/Batches.cmake.
function(twinmap_add_library target)
  cmake_parse_arguments(ARG "" "PRECOMPILED;BATCH" "SOURCES;MORE;LIGHT;PUBLIC;PRIVATE" ${ARGN})
  if(NOT ARG_SOURCES)
    file(GLOB_RECURSE ARG_SOURCES CONFIGURE_DEPENDS *.cpp)
  endif()
  if(ARG_LIGHT)
    string(JOIN "|" light_folders ${ARG_LIGHT})
    set(light_sources ${ARG_SOURCES})
    list(FILTER light_sources INCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/(${light_folders})/")
    list(FILTER ARG_SOURCES EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/(${light_folders})/")
    add_library(${target}_light OBJECT ${light_sources})
    target_include_directories(${target}_light PUBLIC "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${target}_light PRIVATE ${ARG_PUBLIC} ${ARG_PRIVATE})
    twinmap_use_precompiled(${target}_light light)
    twinmap_compile_in_batches(${target}_light light)
    list(APPEND ARG_MORE $<TARGET_OBJECTS:${target}_light>)
  endif()
  add_library(${target} STATIC ${ARG_SOURCES} ${ARG_MORE})
  target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  if(NOT ARG_PRECOMPILED)
    set(ARG_PRECOMPILED framework)
  endif()
  twinmap_use_precompiled(${target} ${ARG_PRECOMPILED})
  twinmap_compile_in_batches(${target} ${ARG_PRECOMPILED} ${ARG_BATCH})
endfunction()
