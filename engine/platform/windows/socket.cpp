#include "platform/socket.h"

#include <winsock2.h>
#include <ws2tcpip.h>

#include <algorithm>
#include <climits>
#include <memory>

namespace palpa {
namespace {

// Winsock has to be started once; the system ends it with the program.
bool start_winsock() noexcept {
    static const bool is_started = [] {
        WSADATA data{};
        return WSAStartup(MAKEWORD(2, 2), &data) == 0;
    }();
    return is_started;
}

// Numbers of Winsock's own, of which those that callers tell apart become errno's.
std::error_code to_error(int code) noexcept {
    switch (code) {
        case WSAECONNREFUSED:
            return std::make_error_code(std::errc::connection_refused);
        case WSAECONNRESET:
            return std::make_error_code(std::errc::connection_reset);
        case WSAEADDRINUSE:
        case WSAEACCES:  // another has the port for itself
            return std::make_error_code(std::errc::address_in_use);
        case WSAEADDRNOTAVAIL:
            return std::make_error_code(std::errc::address_not_available);
        case WSAETIMEDOUT:
            return std::make_error_code(std::errc::timed_out);
        default:
            return {code, std::system_category()};
    }
}

SOCKET socket_of(std::intptr_t handle) noexcept { return static_cast<SOCKET>(handle); }

// An invalid one is -1, as ours.
std::intptr_t handle_of(SOCKET socket) noexcept { return static_cast<std::intptr_t>(socket); }

void set_option(SOCKET socket, int level, int name) noexcept {
    const BOOL on = TRUE;
    ::setsockopt(socket, level, name, reinterpret_cast<const char*>(&on), sizeof on);
}

// Never waits, sends small messages at once.
bool prepare_socket(SOCKET socket) noexcept {
    set_option(socket, IPPROTO_TCP, TCP_NODELAY);
    u_long on = 1;
    return ::ioctlsocket(socket, FIONBIO, &on) == 0;
}

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Addresses find_addresses(const std::string& address, std::uint16_t port) {
    addrinfo hints{};
    hints.ai_flags = AI_NUMERICHOST;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string numbers = address == "localhost" ? "127.0.0.1" : address;
    if (!start_winsock() ||
        ::getaddrinfo(numbers.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
        found = nullptr;
    }
    return {found, &::freeaddrinfo};
}

}  // namespace

Socket Socket::connect(const std::string& address, std::uint16_t port, std::error_code& error) {
    error = std::make_error_code(std::errc::invalid_argument);
    const Addresses found = find_addresses(address, port);
    if (!found) return {};
    Socket socket(handle_of(::socket(found->ai_family, SOCK_STREAM, 0)));
    const SOCKET native = socket_of(socket.handle_);
    const bool is_begun =
        socket.is_open() && prepare_socket(native) &&
        (::connect(native, found->ai_addr, static_cast<int>(found->ai_addrlen)) == 0 ||
         WSAGetLastError() == WSAEWOULDBLOCK);
    error = is_begun ? std::error_code() : to_error(WSAGetLastError());
    return is_begun ? std::move(socket) : Socket();
}

Socket Socket::listen(const std::string& address, std::uint16_t port, std::error_code& error) {
    error = std::make_error_code(std::errc::invalid_argument);
    const Addresses found = find_addresses(address, port);
    if (!found) return {};
    Socket socket(handle_of(::socket(found->ai_family, SOCK_STREAM, 0)));
    const SOCKET native = socket_of(socket.handle_);
    // Otherwise another program could take the same port beside this one.
    if (socket.is_open()) set_option(native, SOL_SOCKET, SO_EXCLUSIVEADDRUSE);
    const bool is_listening =
        socket.is_open() && prepare_socket(native) &&
        ::bind(native, found->ai_addr, static_cast<int>(found->ai_addrlen)) == 0 &&
        ::listen(native, 8) == 0;
    error = is_listening ? std::error_code() : to_error(WSAGetLastError());
    return is_listening ? std::move(socket) : Socket();
}

Socket Socket::accept(std::error_code& error) const {
    error.clear();
    Socket socket(handle_of(::accept(socket_of(handle_), nullptr, nullptr)));
    if (socket.is_open() && prepare_socket(socket_of(socket.handle_))) return socket;
    const int code = WSAGetLastError();
    if (code != WSAEWOULDBLOCK && code != WSAECONNRESET) error = to_error(code);
    return {};
}

std::uint16_t Socket::find_port() const noexcept {
    sockaddr_storage address{};
    int size = sizeof address;
    if (::getsockname(socket_of(handle_), reinterpret_cast<sockaddr*>(&address), &size) != 0)
        return 0;
    return address.ss_family == AF_INET6
               ? ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port)
               : ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

std::error_code Socket::find_error() const noexcept {
    int code = 0;
    int size = sizeof code;
    if (::getsockopt(socket_of(handle_), SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&code),
                     &size) != 0) {
        code = WSAGetLastError();
    }
    return code == 0 ? std::error_code() : to_error(code);
}

SocketTransfer Socket::read(std::span<std::byte> into) const noexcept {
    const int most = static_cast<int>(std::min(into.size(), std::size_t{INT_MAX}));
    const int got = ::recv(socket_of(handle_), reinterpret_cast<char*>(into.data()), most, 0);
    if (got < 0) {
        const int code = WSAGetLastError();
        if (code == WSAEWOULDBLOCK) return {};
        return {.error = to_error(code)};
    }
    return {.bytes = static_cast<std::size_t>(got), .is_ended = got == 0 && !into.empty()};
}

SocketTransfer Socket::write(std::span<const std::byte> bytes) const noexcept {
    const int most = static_cast<int>(std::min(bytes.size(), std::size_t{INT_MAX}));
    const int sent =
        ::send(socket_of(handle_), reinterpret_cast<const char*>(bytes.data()), most, 0);
    if (sent < 0) {
        const int code = WSAGetLastError();
        if (code == WSAEWOULDBLOCK) return {};
        return {.error = to_error(code)};
    }
    return {.bytes = static_cast<std::size_t>(sent)};
}

void Socket::end_writing() const noexcept { ::shutdown(socket_of(handle_), SD_SEND); }

void Socket::close() noexcept {
    if (is_open()) ::closesocket(socket_of(std::exchange(handle_, none)));
}

// By select: WSAPoll of older systems never says that a connection was refused.
void wait_for_sockets(std::span<AwaitedSocket> sockets, int at_most_ms) {
    const int wait_ms = std::max(at_most_ms, 0);
    if (sockets.empty()) {
        Sleep(static_cast<DWORD>(wait_ms));
        return;
    }
    fd_set input, room, failed;
    FD_ZERO(&input);
    FD_ZERO(&room);
    FD_ZERO(&failed);
    for (const AwaitedSocket& awaited : sockets) {
        const SOCKET native = socket_of(awaited.socket->handle());
        FD_SET(native, &input);
        FD_SET(native, &failed);
        if (awaited.for_room) FD_SET(native, &room);
    }
    timeval longest{wait_ms / 1000, 1000 * (wait_ms % 1000)};
    const int ready = ::select(0, &input, &room, &failed, &longest);
    for (AwaitedSocket& awaited : sockets) {
        const SOCKET native = socket_of(awaited.socket->handle());
        const bool is_over = ready > 0 && FD_ISSET(native, &failed);
        awaited.has_input = is_over || (ready > 0 && FD_ISSET(native, &input));
        awaited.has_room = is_over || (ready > 0 && FD_ISSET(native, &room));
    }
}

}  // namespace palpa
