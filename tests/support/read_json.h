// JSON files of the reference cases; for the sources of tests/support, since the parser takes long
// to compile.
#pragma once
#include "core/files.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace palpa::test {

inline nlohmann::json read_json(const std::filesystem::path& path) {
    return nlohmann::json::parse(read_text_file(path));
}

}  // namespace palpa::test
