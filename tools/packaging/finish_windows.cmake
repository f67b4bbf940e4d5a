# For cpack: font, notices and README.txt into the archive for Windows.
file(GLOB_RECURSE program "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/palpa.exe")
if(NOT program)
    message(FATAL_ERROR "no bin/palpa.exe below ${CPACK_TEMPORARY_INSTALL_DIRECTORY}")
endif()
get_filename_component(folder ${program}/../.. ABSOLUTE)
set(documents ${folder}/share/doc/palpa)
include(${CMAKE_CURRENT_LIST_DIR}/copy_notices.cmake)
execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/../windows/finish ${folder} ${CPACK_PACKAGE_VERSION}
    COMMAND_ERROR_IS_FATAL ANY)
