# Writes commit.h anew where the commit has changed since the last build.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git describe --always --dirty WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
    set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT
"// The commit that this program was built from.
#pragma once
inline constexpr const char* commit_name = \"@commit@\";
" @ONLY)
