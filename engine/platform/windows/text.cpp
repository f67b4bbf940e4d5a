#include "platform/windows/text.h"

#include <windows.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cwchar>
#include <utility>

namespace palpa {

std::wstring to_wide(std::string_view utf8) {
    const int letters = static_cast<int>(utf8.size());
    std::wstring wide(
        static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, utf8.data(), letters, nullptr, 0)),
        L'\0');
    MultiByteToWideChar(CP_UTF8, 0, utf8.data(), letters, wide.data(),
                        static_cast<int>(wide.size()));
    return wide;
}

std::string to_utf8(std::wstring_view wide) {
    const int letters = static_cast<int>(wide.size());
    std::string utf8(static_cast<std::size_t>(WideCharToMultiByte(CP_UTF8, 0, wide.data(), letters,
                                                                  nullptr, 0, nullptr, nullptr)),
                     '\0');
    WideCharToMultiByte(CP_UTF8, 0, wide.data(), letters, utf8.data(),
                        static_cast<int>(utf8.size()), nullptr, nullptr);
    return utf8;
}

}  // namespace palpa

#ifdef __MINGW32__
// Reads a character of UTF-8. GCC's std::filesystem::path converts char by mbrtowc(), and
// msvcrt.dll has no UTF-8, so the linker puts this function into its place. A character beyond 16
// bits is given in two calls: the first takes three of its four bytes, and `state` keeps the second
// half until the last one.
extern "C" std::size_t __wrap_mbrtowc(wchar_t* to, const char* from, std::size_t count,
                                      mbstate_t* state) {
    constexpr auto wrong = static_cast<std::size_t>(-1), incomplete = static_cast<std::size_t>(-2);
    static thread_local mbstate_t own = 0;
    if (!state) state = &own;
    if (!from) {
        *state = 0;
        return 0;
    }
    if (count == 0) return incomplete;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(from[i]); };
    const auto give = [&](unsigned letter, std::size_t taken) {
        if (to) *to = static_cast<wchar_t>(letter);
        return letter == 0 ? 0 : taken;
    };
    if (*state != 0) return give(static_cast<unsigned>(std::exchange(*state, 0)), 1);
    if (byte(0) < 0x80) return give(byte(0), 1);
    const std::size_t bytes = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
    unsigned letter = byte(0) & (0x7FU >> bytes);
    for (std::size_t i = 1; i < std::min(bytes, count); ++i) {
        if ((byte(i) & 0xC0U) != 0x80) letter = UINT_MAX >> 6U;
        letter = (letter << 6U) | (byte(i) & 0x3FU);
    }
    constexpr std::array<unsigned, 5> least{0, 0, 0x80, 0x800, 0x10000};  // by bytes
    const bool is_half = letter >= 0xD800 && letter < 0xE000;
    if (byte(0) < 0xC2 || byte(0) > 0xF4 || letter > 0x10FFFF || is_half)
        return errno = EILSEQ, wrong;
    if (count < bytes) return incomplete;
    if (letter < least[bytes]) return errno = EILSEQ, wrong;
    if (bytes < 4) return give(letter, bytes);
    *state = static_cast<mbstate_t>(0xDC00 + (letter & 0x3FFU));
    return give(0xD800 + ((letter - 0x10000) >> 10U), 3);
}
#endif
