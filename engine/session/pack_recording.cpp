#include "session/pack_recording.h"

#include <system_error>
#include <utility>

namespace palpa {

RecordingPacker::RecordingPacker(std::filesystem::path folder)
    : folder_(std::move(folder)), lock_(folder_) {
    for (const std::string_view name : packed_names) {
        std::error_code error;
        const std::uintmax_t bytes = std::filesystem::file_size(folder_ / name, error);
        if (error) continue;  // a run without a window has no journal
        files_.push_back(folder_ / name);
        all_bytes_ += bytes;
    }
}

bool RecordingPacker::pack_piece() {
    if (!packer_) {
        if (files_.empty()) return false;
        packer_.emplace(files_.back());
        files_.pop_back();
    }
    if (packer_->pack_piece()) return true;
    done_bytes_ += packer_->read_bytes();
    packer_.reset();
    return !files_.empty();
}

double RecordingPacker::share() const noexcept {
    const std::uint64_t done = done_bytes_ + (packer_ ? packer_->read_bytes() : 0);
    return all_bytes_ == 0 ? 1 : static_cast<double>(done) / static_cast<double>(all_bytes_);
}

void pack_recording(const std::filesystem::path& folder,
                    const std::function<void(double share)>& progress) {
    RecordingPacker packer(folder);
    while (packer.pack_piece()) {
        if (progress) progress(packer.share());
    }
}

}  // namespace palpa
