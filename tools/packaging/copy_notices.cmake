# The notices of the libraries that are compiled into the program, which their licences want in every
# copy of it, from Debian's packages. `documents`: the folder share/doc/palpa.
set(compiled_in libcli11-dev libeigen3-dev gemmi-dev libglm-dev libimgui-dev nlohmann-json3-dev tao-pegtl-dev)
file(MAKE_DIRECTORY ${documents}/compiled-in)
foreach(package IN LISTS compiled_in)
    file(COPY_FILE /usr/share/doc/${package}/copyright ${documents}/compiled-in/${package}.txt)
    file(CHMOD ${documents}/compiled-in/${package}.txt PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
endforeach()
