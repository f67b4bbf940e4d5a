# Writes version.h anew where version or commit have changed since the last build.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git describe --always --dirty WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
    set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT
"// The version and the commit that this program was built from.
#pragma once

namespace palpa {
inline constexpr const char* version_name = \"@VERSION@\";
inline constexpr const char* commit_name = \"@commit@\";
}  // namespace palpa
" @ONLY)
