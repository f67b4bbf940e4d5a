// Palpa.exe of the zip: starts bin\palpa.exe with the same arguments and without a console, and
// shows its errors in a box.
#include <windows.h>
#include <array>
#include <string>

namespace {

// Collects the program's error messages until it ends, and returns the last of them. The pipe may
// outlive the program, in others that it has started.
std::string read_last(HANDLE program, HANDLE pipe) {
    constexpr std::size_t most = 2000;
    constexpr DWORD between_ms = 50;
    std::string text;
    std::array<char, 4096> part{};
    for (bool has_ended = false; !has_ended;) {
        has_ended = WaitForSingleObject(program, between_ms) == WAIT_OBJECT_0;
        DWORD there = 0, got = 0;
        while (PeekNamedPipe(pipe, nullptr, 0, nullptr, &there, nullptr) && there > 0 &&
               ReadFile(pipe, part.data(), static_cast<DWORD>(part.size()), &got, nullptr)) {
            text.append(part.data(), got);
            if (text.size() > most) text.erase(0, text.size() - most);
        }
    }
    return text;
}

std::wstring to_wide(const std::string& utf8) {
    std::wstring wide(utf8.size(), L'\0');  // never more letters than bytes
    const int letters = MultiByteToWideChar(CP_UTF8, 0, utf8.data(), static_cast<int>(utf8.size()),
                                            wide.data(), static_cast<int>(wide.size()));
    wide.resize(static_cast<std::size_t>(letters));
    return wide;
}

// Returns the command line behind the program's own name, as it was typed.
std::wstring read_arguments() {
    const wchar_t* at = GetCommandLineW();
    const wchar_t end = *at == L'"' ? L'"' : L' ';
    for (at += *at == L'"'; *at != L'\0' && *at != end;) ++at;
    return *at == L'"' ? at + 1 : at;
}

int show(const std::wstring& text) {
    MessageBoxW(nullptr, text.c_str(), L"Palpa", MB_OK | MB_ICONERROR);
    return 1;
}

}  // namespace

int WINAPI wWinMain(HINSTANCE /*program*/, HINSTANCE /*none*/, PWSTR /*line*/, int /*show*/) {
    std::wstring folder(32768, L'\0');
    folder.resize(GetModuleFileNameW(nullptr, folder.data(), static_cast<DWORD>(folder.size())));
    folder.resize(folder.rfind(L'\\'));
    const std::wstring program = folder + L"\\bin\\palpa.exe";
    std::wstring line = L"\"" + program + L"\"" + read_arguments();

    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    HANDLE from = nullptr, to = nullptr;
    if (!CreatePipe(&from, &to, &inherited, 0)) return show(L"Windows gives no pipe.");
    SetHandleInformation(from, HANDLE_FLAG_INHERIT, 0);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    // Lists that it prints would push the error out of the box.
    start.hStdOutput = CreateFileW(L"NUL", GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                                   &inherited, OPEN_EXISTING, 0, nullptr);
    start.hStdError = to;
    PROCESS_INFORMATION child{};
    if (!CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE, CREATE_NO_WINDOW,
                        nullptr, nullptr, &start, &child)) {
        return show(program +
                    L" cannot be started. Unpack the whole zip, and keep its folders together.");
    }
    const std::string printed = read_last(child.hProcess, from);
    DWORD code = 0;
    GetExitCodeProcess(child.hProcess, &code);
    if (code == 0) return 0;
    show(L"Palpa ended with code " + std::to_wstring(code) + L".\n\n" + to_wide(printed));
    return static_cast<int>(code);
}
