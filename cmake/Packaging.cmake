# What is installed beside programs and libraries, and the Debian package of all of it (scripts/package).

# Written by the command itself: completion, schema and, where help2man is, man pages.
set(TWINMAP_SHARE "${PROJECT_BINARY_DIR}/share")
find_program(HELP2MAN help2man)
if(NOT TWINMAP_SANITIZE)
  set(man_pages COMMAND "${CMAKE_COMMAND}" -E echo "no man pages: help2man is not installed")
  if(HELP2MAN)
    set(man_pages COMMAND "${PROJECT_SOURCE_DIR}/scripts/make-man-pages" "$<TARGET_FILE:twinmap>" "${TWINMAP_SHARE}/man")
  endif()
  add_custom_command(OUTPUT "${TWINMAP_SHARE}/experiment.schema.json"
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${TWINMAP_SHARE}/completion" "${TWINMAP_SHARE}/man"
    COMMAND twinmap completion bash > "${TWINMAP_SHARE}/completion/twinmap"
    COMMAND twinmap completion zsh > "${TWINMAP_SHARE}/completion/_twinmap"
    COMMAND twinmap completion fish > "${TWINMAP_SHARE}/completion/twinmap.fish"
    ${man_pages}
    COMMAND twinmap schema > "${TWINMAP_SHARE}/experiment.schema.json"
    DEPENDS twinmap "${PROJECT_SOURCE_DIR}/scripts/make-man-pages"
    COMMENT "Completion, man pages and schema" VERBATIM)
  add_custom_target(twinmap_share ALL DEPENDS "${TWINMAP_SHARE}/experiment.schema.json")

  install(FILES "${TWINMAP_SHARE}/completion/twinmap" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
  install(FILES "${TWINMAP_SHARE}/completion/_twinmap" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")
  install(FILES "${TWINMAP_SHARE}/completion/twinmap.fish" DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
  install(DIRECTORY "${TWINMAP_SHARE}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" FILES_MATCHING PATTERN "*.1")
  install(FILES "${TWINMAP_SHARE}/experiment.schema.json" DESTINATION "${CMAKE_INSTALL_DATADIR}/twinmap")
endif()
# A live twin as a service, not started by itself (docs/how-to/serve-a-twin.md).
install(FILES "cmake/systemd/twinmap-serve@.service" DESTINATION lib/systemd/system)
# The documents as a site with search, where MkDocs is.
find_program(MKDOCS mkdocs)
if(MKDOCS AND NOT TWINMAP_SANITIZE)
  file(GLOB_RECURSE pages CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/*.md" "${PROJECT_SOURCE_DIR}/docs/images/*")
  add_custom_command(OUTPUT "${TWINMAP_SHARE}/html/index.html"
    COMMAND /usr/bin/python3 "${PROJECT_SOURCE_DIR}/scripts/docs" "${TWINMAP_SHARE}/html"
    DEPENDS ${pages} "${PROJECT_SOURCE_DIR}/scripts/docs" "${PROJECT_SOURCE_DIR}/scripts/mkdocs.yml"
    COMMENT "Documents as a site" VERBATIM)
  add_custom_target(twinmap_site ALL DEPENDS "${TWINMAP_SHARE}/html/index.html")
  install(DIRECTORY "${TWINMAP_SHARE}/html/" DESTINATION "${CMAKE_INSTALL_DOCDIR}/html")
endif()
install(DIRECTORY experiments/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/examples/experiments"
  PATTERN "*.fmu" EXCLUDE PATTERN "__pycache__" EXCLUDE)
install(FILES README.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs" FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME twinmap)
set(CPACK_PACKAGE_CONTACT "The twinmap authors <twinmap@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "estimate the physical parameters of digital twins")
set(CPACK_PACKAGE_DESCRIPTION "twinmap simulates a first-principles model of a machine for many
parameter sets, trains maps from features of the response to the
parameters, and infers parameters with a calibrated standard deviation from
measured responses, online.
.
This package has the command, the library libtwinmap with its header, the
Python package, man pages, completion for shells, documents and examples.
It runs on processors with AVX2 and FMA (x86-64-v3).")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
file(WRITE "${PROJECT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/triggers" "${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3-numpy, python3-pandas")
set(CPACK_DEBIAN_PACKAGE_PROVIDES "libtwinmap0, libtwinmap-dev, python3-twinmap")
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/DebianFiles.cmake")
include(CPack)
