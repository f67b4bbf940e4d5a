#include "session/kept_text.h"

#include <array>

namespace palpa {

KeptText::KeptText(std::size_t most) : most_(most), file_(std::tmpfile()) {}

void KeptText::add(std::string_view text) {
    if (!is_whole_) return;
    size_ += text.size();
    check_size();
    if (!is_whole_) return;
    if (!file_) {
        memory_ += text;
    } else if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) {
        forget();
    }
}

void KeptText::set_beside(std::size_t bytes) {
    beside_ = bytes;
    check_size();
}

bool KeptText::hand_to(const std::function<void(std::string_view)>& take) {
    if (!is_whole_) return false;
    if (!file_) {
        take(memory_);
        return true;
    }
    std::FILE* const file = file_.get();
    if (std::fflush(file) != 0) {
        forget();
        return false;
    }
    // Whatever happens, what is added later follows all that is there.
    struct AtEnd {
        ~AtEnd() {
            if (std::fseek(kept.file_.get(), 0, SEEK_END) != 0) kept.forget();
        }
        KeptText& kept;
    };
    const AtEnd at_end{*this};
    if (std::fseek(file, 0, SEEK_SET) != 0) return false;
    std::array<char, 1 << 16> piece;
    std::size_t left = size_;
    while (left > 0) {
        const std::size_t got = std::fread(piece.data(), 1, piece.size(), file);
        if (got == 0) break;
        take({piece.data(), got});
        left -= got;
    }
    return left == 0;
}

void KeptText::forget() noexcept {
    is_whole_ = false;
    file_.reset();
    memory_ = {};
}

void KeptText::check_size() noexcept {
    if (size_ + beside_ > most_) forget();
}

}  // namespace palpa
