// Reads and writes binary files: numbers in either byte order, bytes at any offset.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace palpa {

// The number in the sizeof(T) bytes at `bytes`, in this byte order.
template <class T>
T number_from(const char* bytes, std::endian order) noexcept {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8);
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        const std::size_t at = order == std::endian::big ? i : sizeof(T) - 1 - i;
        bits = static_cast<Bits>(bits << 8) | static_cast<unsigned char>(bytes[at]);
    }
    return std::bit_cast<T>(bits);
}

// Appends the bytes of a number to `text`.
template <class T>
void append_number(std::string& text, T value, std::endian order) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8);
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    const auto bits = std::bit_cast<Bits>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        const std::size_t at = order == std::endian::big ? sizeof(T) - 1 - i : i;
        text += static_cast<char>(static_cast<unsigned char>(bits >> (8 * at)));
    }
}

// Reads bytes of a file or of memory at any offset. For one thread.
class ByteSource {
public:
    // Throws LoadError if the file is missing, not a regular file, or unreadable.
    explicit ByteSource(const std::filesystem::path& path);
    // `name` stands for the file in messages.
    ByteSource(std::string bytes, std::string name);

    const std::string& name() const noexcept { return name_; }
    // Size in bytes when the file was opened.
    std::uint64_t size() const noexcept { return size_; }

    // Fills `into`. Throws LoadError if the file does not have these bytes (any more).
    void read(std::uint64_t offset, std::span<char> into);

private:
    std::string name_;
    std::unique_ptr<std::istream> stream_;
    std::uint64_t size_ = 0;
};

// A new file that grows and can be overwritten. All functions throw LoadError.
class GrowingFile {
public:
    explicit GrowingFile(const std::filesystem::path& path);

    const std::string& name() const noexcept { return name_; }
    // Both pass the bytes to the system before they return.
    void append(std::string_view bytes);
    void replace(std::uint64_t offset, std::string_view bytes);
    void close();

private:
    void check();

    std::string name_;
    std::fstream stream_;
};

}  // namespace palpa
