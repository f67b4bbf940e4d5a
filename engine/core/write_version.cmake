# Writes version.cpp anew where version or commit have changed since the last build.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git describe --always --dirty WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
    set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT
"#include \"core/version.h\"

namespace palpa {
const char* const version_name = \"@VERSION@\";
const char* const commit_name = \"@commit@\";
}  // namespace palpa
" @ONLY)
