# Packages for a build with mingw-w64 on Debian, which has zlib alone of them. Of the others the
# headers do, and the names of functions: a program that is linked against these starts without the
# libraries, and ends where it calls one.

set(palpa_headers ${CMAKE_BINARY_DIR}/include)
set(palpa_provided CLI11 Catch2 Eigen3 PNG SDL2 Vulkan fmt glfw3 glm hidapi hwy imgui nlohmann_json tomlplusplus)

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

# Of `dll` the functions that stand in `text` as `pattern`, whose first group is their name.
function(palpa_link name dll text pattern)
    string(REGEX MATCHALL "${pattern}" found "${text}")
    set(lines "LIBRARY ${dll}\nEXPORTS\n")
    foreach(each IN LISTS found)
        string(REGEX REPLACE "${pattern}" "\\1" function "${each}")
        string(APPEND lines "${function}\n")
    endforeach()
    set(library ${CMAKE_BINARY_DIR}/lib${dll}.a)
    file(WRITE ${library}.def "${lines}")
    execute_process(COMMAND x86_64-w64-mingw32-dlltool -d ${library}.def -D ${dll} --output-delaylib ${library}
        COMMAND_ERROR_IS_FATAL ANY)
    target_link_libraries(${name} INTERFACE ${library})
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

macro(palpa_provide_PNG)
    palpa_take(png.h)
    palpa_take(pngconf.h)
    palpa_take(pnglibconf.h)
    find_package(ZLIB REQUIRED)
    palpa_library(PNG::PNG)
    target_link_libraries(PNG::PNG INTERFACE ZLIB::ZLIB)
    file(READ /usr/include/png.h text)
    palpa_link(PNG::PNG libpng16-16.dll "${text}"
        "PNG_EXPORTA?\\([0-9]+,[ \n]*[a-z_ 0-9*]+,[ \n]*(png_[a-z_0-9]+)")
endmacro()

macro(palpa_provide_SDL2)
    palpa_take(SDL2)
    palpa_library(SDL2::SDL2 ${palpa_headers}/SDL2 ${palpa_headers}/config)
    # Debian's own is of Linux; what its headers ask of a compiler is true of all that know C99.
    file(WRITE ${palpa_headers}/config/SDL2/_real_SDL_config.h [[
#define SIZEOF_VOIDP 8
#define HAVE_STDARG_H 1
#define HAVE_STDDEF_H 1
#define HAVE_STDINT_H 1
#define HAVE_STDIO_H 1
#define HAVE_STDLIB_H 1
#define HAVE_STRING_H 1
]])
    set(text "")
    foreach(header SDL SDL_audio SDL_error SDL_hints SDL_timer)
        file(READ /usr/include/SDL2/${header}.h part)
        string(APPEND text "${part}")
    endforeach()
    palpa_link(SDL2::SDL2 SDL2.dll "${text}" "SDLCALL[ \n]+(SDL_[A-Za-z0-9]+)\\(")
endmacro()

macro(palpa_provide_Vulkan)
    palpa_take(vulkan)
    palpa_take(vk_video)
    palpa_library(Vulkan::Headers)
    palpa_library(Vulkan::Vulkan)
    file(READ /usr/include/vulkan/vulkan_core.h text)
    palpa_link(Vulkan::Vulkan vulkan-1.dll "${text}" "VKAPI_CALL (vk[A-Za-z0-9]+)\\(")
    find_program(PALPA_GLSLANG glslangValidator REQUIRED)
    add_executable(Vulkan::glslangValidator IMPORTED GLOBAL)
    set_target_properties(Vulkan::glslangValidator PROPERTIES IMPORTED_LOCATION ${PALPA_GLSLANG})
endmacro()

macro(palpa_provide_fmt)
    palpa_take(fmt)
    palpa_library(fmt::fmt)
    target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
endmacro()

macro(palpa_provide_glfw3)
    palpa_take(GLFW)
    palpa_library(glfw)
    file(READ /usr/include/GLFW/glfw3.h text)
    palpa_link(glfw glfw3.dll "${text}" "GLFWAPI [^;(]*(glfw[A-Za-z0-9]+)\\(")
endmacro()

macro(palpa_provide_glm)
    palpa_take(glm)
    palpa_library(glm::glm)
endmacro()

macro(palpa_provide_hidapi)
    palpa_take(hidapi)
    palpa_library(hidapi::hidapi)
    file(READ /usr/include/hidapi/hidapi.h text)
    palpa_link(hidapi::hidapi hidapi.dll "${text}" "HID_API_CALL (hid_[a-z_]+)\\(")
endmacro()

macro(palpa_provide_hwy)
    palpa_take(hwy)
    add_library(palpa_highway STATIC ${PROJECT_SOURCE_DIR}/tools/scripts/windows_highway.cpp)
    target_compile_features(palpa_highway PRIVATE cxx_std_20)
    target_include_directories(palpa_highway SYSTEM PUBLIC ${palpa_headers})
    # One kind of processor: what the compiler is told of, which is none in particular.
    target_compile_definitions(palpa_highway PUBLIC HWY_COMPILE_ONLY_STATIC)
    add_library(hwy::hwy ALIAS palpa_highway)
endmacro()

macro(palpa_provide_imgui)
    palpa_take(imgui)
    palpa_library(imgui::imgui ${palpa_headers}/imgui ${palpa_headers}/imgui/backends)
    # C++ calls the functions the same on both systems, but for a size_t: behind a char* its name changes.
    file(GLOB library /usr/lib/*/libimgui.a)
    execute_process(COMMAND nm --defined-only ${library} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "Pcm" "Pcy" text "${text}")
    palpa_link(imgui::imgui imgui.dll "${text}" " T (_Z[A-Za-z0-9_]+)")
    # Its one variable that is ours to see.
    file(WRITE ${CMAKE_BINARY_DIR}/imgui_context.cpp "struct ImGuiContext;\nextern ImGuiContext* GImGui;\nImGuiContext* GImGui = nullptr;\n")
    add_library(palpa_imgui_context STATIC ${CMAKE_BINARY_DIR}/imgui_context.cpp)
    target_link_libraries(imgui::imgui INTERFACE palpa_imgui_context)
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
