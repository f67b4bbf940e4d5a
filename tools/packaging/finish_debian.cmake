# For cpack: what Debian wants besides the installed files: copyright, changelog, compressed pages.
file(GLOB_RECURSE manual "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/palpa.1")
file(GLOB_RECURSE licence "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/LICENSE")
list(FILTER licence INCLUDE REGEX "/doc/palpa/LICENSE$")
if(NOT manual OR NOT licence)
    message(FATAL_ERROR "no palpa.1 or LICENSE below ${CPACK_TEMPORARY_INSTALL_DIRECTORY}")
endif()
get_filename_component(documents ${licence} DIRECTORY)
file(REMOVE ${licence})  # its words are in `copyright`
file(COPY ${CPACK_PALPA_FILES}/copyright ${CPACK_PALPA_FILES}/changelog DESTINATION ${documents}
    FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
include(${CMAKE_CURRENT_LIST_DIR}/copy_notices.cmake)
# Without name and time, so that the same files make the same package.
execute_process(COMMAND gzip -9nf ${documents}/changelog ${manual} COMMAND_ERROR_IS_FATAL ANY)
