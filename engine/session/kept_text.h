// Text that grows for hours and may never be asked for: in a temporary file without a name, so that
// the program's memory does not grow with it; in memory where there can be none.
#pragma once
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace palpa {

class KeptText {
public:
    // `most`: bytes. Beyond these, and where the disk is full, nothing is kept any more.
    explicit KeptText(std::size_t most);

    void add(std::string_view text);
    // `bytes` that count against the limit and are kept elsewhere, in place of those before.
    void set_beside(std::size_t bytes);

    bool is_whole() const noexcept { return is_whole_; }
    // All of it in its order, piece by piece; false where it could not be read back. What `take`
    // throws goes on to the caller, and nothing is lost by it.
    [[nodiscard]] bool hand_to(const std::function<void(std::string_view)>& take);

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
    };

    void forget() noexcept;
    void check_size() noexcept;

    std::size_t most_, size_ = 0, beside_ = 0;
    bool is_whole_ = true;
    std::unique_ptr<std::FILE, Close> file_;
    std::string memory_;  // where there is no file
};

}  // namespace palpa
