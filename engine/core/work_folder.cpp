#include "core/work_folder.h"

#include "core/load_error.h"
#include "platform/file.h"

#include <fmt/format.h>
#include <system_error>

namespace palpa {

WorkFolder::WorkFolder() {
    std::error_code error;
    path_ = make_temporary_folder(error);
    if (error) {
        std::error_code ignored;
        const std::filesystem::path name =
            std::filesystem::temp_directory_path(ignored) / "palpa-XXXXXX";
        throw LoadError(
            {name.string()},
            fmt::format("this folder for temporary files cannot be made: {}", error.message()));
    }
}

WorkFolder::~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace palpa
