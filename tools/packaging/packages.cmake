# What cpack makes of the installed files: a Debian package (-G DEB) and a portable archive (-G TXZ).
# tools/scripts/package makes both; tools/packaging.md explains them.
set(packaging ${CMAKE_CURRENT_LIST_DIR})
set(PALPA_MAINTAINER "The Palpa authors <palpa@example.org>" CACHE STRING
    "Whom the Debian package names as its maintainer: NAME <ADDRESS>")
string(TOLOWER "${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}" system)

if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
    install(FILES ${packaging}/palpa.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
    install(FILES ${packaging}/palpa.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
    install(FILES ${packaging}/palpa.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
endif()

set(CPACK_GENERATOR TGZ)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_FILE_NAME palpa-${PROJECT_VERSION}-${system})
set(CPACK_PACKAGE_CONTACT "${PALPA_MAINTAINER}")
set(CPACK_PACKAGE_VENDOR "The Palpa authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "feel molecules with a mouse or a haptic device")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
# Reads CPACK_GENERATOR, once for each package.
set(CPACK_PROJECT_CONFIG_FILE ${packaging}/finish_files.cmake)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Without a driver nothing is drawn; without a font pictures have no words; without libcurl, which is
# loaded when it is needed, no PDB entries are downloaded.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd, fonts-dejavu-core, libcurl4 | libcurl3-gnutls, ca-certificates")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"You hold a molecule with the mouse or a haptic device, and a CHARMM force
field pushes back: hydrogen bonds, salt bridges, a drug in its pocket.

Palpa prepares downloaded structures, moves flexible molecules towards rest
while they are held, records and replays sessions, and draws pictures.
Scenes, lessons and the force field CHARMM36 are part of the package.")
configure_file(${packaging}/changelog.in ${PROJECT_BINARY_DIR}/packaging/changelog @ONLY)
configure_file(${packaging}/copyright ${PROJECT_BINARY_DIR}/packaging/copyright COPYONLY)
set(CPACK_PALPA_FILES ${PROJECT_BINARY_DIR}/packaging)
include(CPack)
