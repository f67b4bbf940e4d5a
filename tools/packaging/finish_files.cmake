# For cpack: which script finishes the installed files before they are packed.
if(CPACK_GENERATOR STREQUAL "DEB")
    set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/finish_debian.cmake)
elseif(CPACK_GENERATOR STREQUAL "TXZ")
    set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/finish_portable.cmake)
elseif(CPACK_GENERATOR STREQUAL "ZIP")
    set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/finish_windows.cmake)
endif()
