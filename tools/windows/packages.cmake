# Packages that find_package does not find for a build with mingw-w64 on Debian: libraries of headers alone, which
# are Debian's own, and two of tools/windows/libraries.

set(palpa_headers ${CMAKE_BINARY_DIR}/include)
set(palpa_libraries $ENV{PALPA_WINDOWS_LIBRARIES})
set(palpa_provided CLI11 Catch2 Eigen3 Vulkan fmt glm imgui nlohmann_json tomlplusplus)
set(ZLIB_USE_STATIC_LIBS ON)

# `folder` of Debian's headers, and not the rest of /usr/include, which is another system's.
function(palpa_take folder)
    file(MAKE_DIRECTORY ${palpa_headers})
    get_filename_component(name ${folder} NAME)
    file(CREATE_LINK /usr/include/${folder} ${palpa_headers}/${name} SYMBOLIC)
endfunction()

function(palpa_library name)
    add_library(${name} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${name} INTERFACE ${palpa_headers} ${ARGN})
endfunction()

macro(palpa_provide method package)
    if("${package}" IN_LIST palpa_provided)
        get_property(palpa_has GLOBAL PROPERTY palpa_has_${package})
        if(NOT palpa_has)
            cmake_language(CALL palpa_provide_${package})
            set_property(GLOBAL PROPERTY palpa_has_${package} TRUE)
        endif()
        set(${package}_FOUND TRUE)
    endif()
endmacro()

macro(palpa_provide_CLI11)
    palpa_take(CLI)
    palpa_library(CLI11::CLI11)
endmacro()

macro(palpa_provide_Catch2)
    palpa_take(catch2)
    palpa_library(Catch2::Catch2)
    # Each program is one test, which starts once under wine.
    file(WRITE ${CMAKE_BINARY_DIR}/modules/Catch.cmake [[
function(catch_discover_tests program)
    if(NOT TEST ${program})
        add_test(NAME ${program} COMMAND ${program} ${palpa_left_out})
        set_tests_properties(${program} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1800)
    endif()
endfunction()
]])
    list(APPEND CMAKE_MODULE_PATH ${CMAKE_BINARY_DIR}/modules)
    # Lines of `module: name of a test case`, comments between them.
    file(STRINGS ${PROJECT_SOURCE_DIR}/tests/not_on_windows.txt palpa_lines REGEX "^[^#]")
    set(palpa_left_out "~[slow]")  # as under the sanitizers
    foreach(line IN LISTS palpa_lines)
        string(REGEX REPLACE "^[a-z]+: " "" line "${line}")
        string(REPLACE "," "\\," line "${line}")
        list(APPEND palpa_left_out "~${line}")
    endforeach()
endmacro()

macro(palpa_provide_Eigen3)
    palpa_take(eigen3/Eigen)
    palpa_take(eigen3/unsupported)
    palpa_library(Eigen3::Eigen)
endmacro()

macro(palpa_provide_Vulkan)
    palpa_take(vulkan)
    palpa_take(vk_video)
    palpa_library(Vulkan::Headers)
    palpa_library(Vulkan::Vulkan)
    target_link_libraries(Vulkan::Vulkan INTERFACE ${palpa_libraries}/lib/libvulkan-1.a)
    find_program(PALPA_GLSLANG glslangValidator REQUIRED)
    add_executable(Vulkan::glslangValidator IMPORTED GLOBAL)
    set_target_properties(Vulkan::glslangValidator PROPERTIES IMPORTED_LOCATION ${PALPA_GLSLANG})
endmacro()

macro(palpa_provide_fmt)
    palpa_take(fmt)
    palpa_library(fmt::fmt)
    target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
endmacro()

macro(palpa_provide_glm)
    palpa_take(glm)
    palpa_library(glm::glm)
endmacro()

macro(palpa_provide_imgui)
    palpa_library(imgui::imgui ${palpa_libraries}/include/imgui)
    target_link_libraries(imgui::imgui INTERFACE ${palpa_libraries}/lib/libimgui.a glfw Vulkan::Vulkan imm32)
endmacro()

macro(palpa_provide_nlohmann_json)
    palpa_take(nlohmann)
    palpa_library(nlohmann_json::nlohmann_json)
endmacro()

macro(palpa_provide_tomlplusplus)
    palpa_take(toml++)
    palpa_library(tomlplusplus::tomlplusplus)
    # toml++ asserts on malformed table headers before it reports them; Debian's library does not.
    target_compile_options(tomlplusplus::tomlplusplus INTERFACE
        -DTOML_HEADER_ONLY=1 "-DTOML_ASSERT(x)=static_cast<void>(0)")
endmacro()

# gemmi's reader of CIF stands on PEGTL.
palpa_take(gemmi)
palpa_take(tao)
set(GEMMI_INCLUDE ${palpa_headers} CACHE PATH "")

cmake_language(SET_DEPENDENCY_PROVIDER palpa_provide SUPPORTED_METHODS FIND_PACKAGE)
