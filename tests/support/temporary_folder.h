// A folder of its own for a test that needs files; gone when the test ends.
#pragma once
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace palpa::test {

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::random_device random;  // tests run beside each other
        do {
            path_ =
                std::filesystem::temp_directory_path() / ("palpa-test-" + std::to_string(random()));
        } while (!std::filesystem::create_directory(path_));
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    const std::filesystem::path& path() const { return path_; }

    // Writes a file without help from the code under test; returns its path.
    std::filesystem::path add_file(const std::string& name, std::string_view text) const {
        std::ofstream file(path_ / name, std::ios::binary);
        file.write(text.data(), static_cast<std::streamsize>(text.size()));
        if (!file.flush()) throw std::runtime_error("cannot write " + name);
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

}  // namespace palpa::test
