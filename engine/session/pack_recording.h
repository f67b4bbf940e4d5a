// Compresses the long files of a recording that has ended: trace.csv becomes trace.csv.gz,
// journal.txt becomes journal.txt.gz. All readers take both forms (read_recorded_file).
#pragma once
#include "core/files.h"
#include "formats/gzip.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace palpa {

inline constexpr std::array<std::string_view, 2> packed_names{"trace.csv", "journal.txt"};

// Works a piece of some 20 ms at a time, so that its thread can do other things meanwhile.
class RecordingPacker {
public:
    // Throws LoadError if another run writes into the folder.
    explicit RecordingPacker(std::filesystem::path folder);
    RecordingPacker(const RecordingPacker&) = delete;
    RecordingPacker& operator=(const RecordingPacker&) = delete;

    // Compresses the next piece; false once all is done. Throws LoadError, as on a full disk: then
    // the rest stays plain.
    [[nodiscard]] bool pack_piece();

    const std::filesystem::path& folder() const noexcept { return folder_; }
    double share() const noexcept;  // of the work that is done

private:
    std::filesystem::path folder_;
    FolderLock lock_;
    std::vector<std::filesystem::path> files_;  // that are not begun yet
    std::optional<FilePacker> packer_;
    std::uint64_t all_bytes_ = 0, done_bytes_ = 0;
};

// All at once.
void pack_recording(const std::filesystem::path& folder,
                    const std::function<void(double share)>& progress = {});

}  // namespace palpa
