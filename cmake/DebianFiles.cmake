# What Debian's policy asks of a package beyond what is installed: copyright, changelog and compressed man pages.
# Run by cpack in the folder that it packs.
set(root "${CPACK_TEMPORARY_INSTALL_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX}")
set(documents "${root}/share/doc/twinmap")
file(COPY_FILE "${CMAKE_CURRENT_LIST_DIR}/../LICENSE" "${documents}/copyright")
file(CHMOD "${documents}/copyright" PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ) # whatever the umask was
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # of SOURCE_DATE_EPOCH, if that is set
file(WRITE "${documents}/changelog" "twinmap (${CPACK_PACKAGE_VERSION}) stable; urgency=medium

  * CHANGELOG.md beside this file tells what there is.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(COPY "${CMAKE_CURRENT_LIST_DIR}/debian/lintian-overrides" DESTINATION "${documents}")
file(MAKE_DIRECTORY "${root}/share/lintian/overrides")
file(RENAME "${documents}/lintian-overrides" "${root}/share/lintian/overrides/twinmap")
file(GLOB pages "${root}/share/man/man1/*.1")
foreach(file "${documents}/changelog" ${pages})
  execute_process(COMMAND gzip -9 -n -f "${file}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
