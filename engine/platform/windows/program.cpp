#include "platform/program.h"

#include "platform/windows/text.h"

#include <windows.h>
#include <array>
#include <cerrno>
#include <cstddef>

namespace palpa {
namespace {

// As the start of a C program takes words apart: backslashes count twice before a quotation mark.
void add_word(const std::wstring& word, std::wstring& line) {
    if (!line.empty()) line += L' ';
    line += L'"';
    std::size_t backslashes = 0;
    for (const wchar_t letter : word) {
        if (letter == L'"') line.append(backslashes + 1, L'\\');
        backslashes = letter == L'\\' ? backslashes + 1 : 0;
        line += letter;
    }
    line.append(backslashes, L'\\');
    line += L'"';
}

// A file that another program inherits, closed with its owner.
class InheritedFile {
public:
    InheritedFile(const wchar_t* path, DWORD access, DWORD creation) {
        SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
        handle_ = CreateFileW(path, access, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited,
                              creation, FILE_ATTRIBUTE_NORMAL, nullptr);
    }
    InheritedFile(const InheritedFile&) = delete;
    InheritedFile& operator=(const InheritedFile&) = delete;
    ~InheritedFile() {
        if (handle_ != INVALID_HANDLE_VALUE) CloseHandle(handle_);
    }
    HANDLE get() const noexcept { return handle_; }

private:
    HANDLE handle_;
};

}  // namespace

std::filesystem::path find_program_file() {
    std::array<wchar_t, 32768> path{};
    const DWORD letters = GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
    return std::wstring(path.data(), letters);
}

std::uint64_t own_process_number() noexcept { return GetCurrentProcessId(); }

bool is_process_running(std::uint64_t number) noexcept {
    const HANDLE process =
        OpenProcess(PROCESS_QUERY_LIMITED_INFORMATION, FALSE, static_cast<DWORD>(number));
    if (!process) return false;
    DWORD code = 0;
    const bool runs = GetExitCodeProcess(process, &code) != 0 && code == STILL_ACTIVE;
    CloseHandle(process);
    return runs;
}

ProgramEnd run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                       const std::filesystem::path& errors) {
    std::wstring line;
    for (const std::string& word : words) add_word(to_wide(word), line);
    const InheritedFile in(L"NUL", GENERIC_READ, OPEN_EXISTING);
    const InheritedFile out(output.c_str(), GENERIC_WRITE, CREATE_ALWAYS);
    const InheritedFile err(errors.c_str(), GENERIC_WRITE, CREATE_ALWAYS);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = in.get();
    start.hStdOutput = out.get();
    start.hStdError = err.get();
    PROCESS_INFORMATION child{};
    if (!CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, 0, nullptr, nullptr, &start,
                        &child)) {
        const DWORD error = GetLastError();
        const bool is_missing = error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND;
        return {is_missing ? ENOENT : EACCES, 0};
    }
    CloseHandle(child.hThread);
    WaitForSingleObject(child.hProcess, INFINITE);
    DWORD code = 0;
    GetExitCodeProcess(child.hProcess, &code);
    CloseHandle(child.hProcess);
    return {0, static_cast<int>(code)};
}

}  // namespace palpa
