# Sources of a part are compiled several at a time, as one unit: headers and templates that they share are worked on once,
# which is most of a build. So a name in an anonymous namespace is unique within its part, and a file still includes what
# it uses: TWINMAP_BATCHES=OFF (the dev preset, scripts/lint) compiles each alone. Sources with flags of their own always are.
option(TWINMAP_BATCHES "Compile several sources of a part at a time: a build from nothing takes half as long" ON)

# twinmap_compile_in_batches(<target> <precompiled> [<files>]): at most so many files a unit, 1: each alone. By default 8
# where code organises (PRECOMPILED light) and 4 where it computes, so that changing one file costs seconds.
function(twinmap_compile_in_batches target precompiled)
  set(files ${ARGN})
  if(NOT files AND precompiled STREQUAL "light")
    set(files 8)
  elseif(NOT files)
    set(files 4)
  endif()
  if(TWINMAP_BATCHES AND files GREATER 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()
