# What Debian's policy asks of a package beyond what is installed: copyright, compressed changelog and man pages.
# Run by cpack in the folder that it packs.
set(root "${CMAKE_INSTALL_PREFIX}")
if(DEFINED ENV{DESTDIR})
  set(root "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
endif()
set(documents "${root}/share/doc/twinmap")
file(COPY_FILE "${CMAKE_CURRENT_LIST_DIR}/../LICENSE" "${documents}/copyright")
file(GLOB pages "${root}/share/man/man1/*.1")
foreach(file "${documents}/CHANGELOG.md" ${pages})
  execute_process(COMMAND gzip -9 -n -f "${file}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME "${documents}/CHANGELOG.md.gz" "${documents}/changelog.gz")
