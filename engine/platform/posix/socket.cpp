#include "platform/socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>

namespace palpa {
namespace {

std::error_code last_socket_error() noexcept { return {errno, std::generic_category()}; }

bool is_not_yet(int code) noexcept {
    return code == EAGAIN || code == EWOULDBLOCK || code == EINTR;
}

void set_option(int descriptor, int level, int name) noexcept {
    const int on = 1;
    ::setsockopt(descriptor, level, name, &on, sizeof on);
}

// Never waits, is not handed to other programs, sends small messages at once.
bool prepare_socket(int descriptor) noexcept {
    set_option(descriptor, IPPROTO_TCP, TCP_NODELAY);
#ifdef SO_NOSIGPIPE
    set_option(descriptor, SOL_SOCKET, SO_NOSIGPIPE);
#endif
    const int flags = ::fcntl(descriptor, F_GETFL);
    return flags >= 0 && ::fcntl(descriptor, F_SETFL, flags | O_NONBLOCK) == 0 &&
           ::fcntl(descriptor, F_SETFD, FD_CLOEXEC) == 0;
}

#ifdef MSG_NOSIGNAL
constexpr int no_signal = MSG_NOSIGNAL;
#else
constexpr int no_signal = 0;  // SO_NOSIGPIPE does it
#endif

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Addresses find_addresses(const std::string& address, std::uint16_t port) {
    addrinfo hints{};
    hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string numbers = address == "localhost" ? "127.0.0.1" : address;
    if (::getaddrinfo(numbers.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
        found = nullptr;
    }
    return {found, &::freeaddrinfo};
}

}  // namespace

Socket Socket::connect(const std::string& address, std::uint16_t port, std::error_code& error) {
    error = std::make_error_code(std::errc::invalid_argument);
    const Addresses found = find_addresses(address, port);
    if (!found) return {};
    Socket socket(::socket(found->ai_family, SOCK_STREAM, 0));
    const int descriptor = static_cast<int>(socket.handle_);
    const bool is_begun = socket.is_open() && prepare_socket(descriptor) &&
                          (::connect(descriptor, found->ai_addr, found->ai_addrlen) == 0 ||
                           errno == EINPROGRESS || errno == EINTR);
    error = is_begun ? std::error_code() : last_socket_error();
    return is_begun ? std::move(socket) : Socket();
}

Socket Socket::listen(const std::string& address, std::uint16_t port, std::error_code& error) {
    error = std::make_error_code(std::errc::invalid_argument);
    const Addresses found = find_addresses(address, port);
    if (!found) return {};
    Socket socket(::socket(found->ai_family, SOCK_STREAM, 0));
    const int descriptor = static_cast<int>(socket.handle_);
    // A port is free again at once after its last owner; two at a time cannot have it.
    if (socket.is_open()) set_option(descriptor, SOL_SOCKET, SO_REUSEADDR);
    const bool is_listening = socket.is_open() && prepare_socket(descriptor) &&
                              ::bind(descriptor, found->ai_addr, found->ai_addrlen) == 0 &&
                              ::listen(descriptor, 8) == 0;
    error = is_listening ? std::error_code() : last_socket_error();
    return is_listening ? std::move(socket) : Socket();
}

Socket Socket::accept(std::error_code& error) const {
    error.clear();
    Socket socket(::accept(static_cast<int>(handle_), nullptr, nullptr));
    if (socket.is_open() && prepare_socket(static_cast<int>(socket.handle_))) return socket;
    // A connection that ended before it was accepted is no error.
    if (!is_not_yet(errno) && errno != ECONNABORTED) error = last_socket_error();
    return {};
}

std::uint16_t Socket::find_port() const noexcept {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (::getsockname(static_cast<int>(handle_), reinterpret_cast<sockaddr*>(&address), &size) !=
        0) {
        return 0;
    }
    return address.ss_family == AF_INET6
               ? ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port)
               : ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

std::error_code Socket::find_error() const noexcept {
    int code = 0;
    socklen_t size = sizeof code;
    if (::getsockopt(static_cast<int>(handle_), SOL_SOCKET, SO_ERROR, &code, &size) != 0) {
        return last_socket_error();
    }
    return {code, std::generic_category()};
}

SocketTransfer Socket::read(std::span<std::byte> into) const noexcept {
    const ssize_t got = ::recv(static_cast<int>(handle_), into.data(), into.size(), 0);
    if (got < 0 && is_not_yet(errno)) return {};
    if (got < 0) return {.error = last_socket_error()};
#ifdef TCP_QUICKACK
    // Linux delays acknowledgements by 40 ms, and a sender of small messages waits for them. The
    // option does not last, so each read sets it again.
    set_option(static_cast<int>(handle_), IPPROTO_TCP, TCP_QUICKACK);
#endif
    return {.bytes = static_cast<std::size_t>(got), .is_ended = got == 0 && !into.empty()};
}

SocketTransfer Socket::write(std::span<const std::byte> bytes) const noexcept {
    const ssize_t sent = ::send(static_cast<int>(handle_), bytes.data(), bytes.size(), no_signal);
    if (sent < 0 && is_not_yet(errno)) return {};
    if (sent < 0) return {.error = last_socket_error()};
    return {.bytes = static_cast<std::size_t>(sent)};
}

void Socket::end_writing() const noexcept { ::shutdown(static_cast<int>(handle_), SHUT_WR); }

void Socket::close() noexcept {
    if (is_open()) ::close(static_cast<int>(std::exchange(handle_, none)));
}

void wait_for_sockets(std::span<AwaitedSocket> sockets, int at_most_ms) {
    std::array<pollfd, 64> polled{};
    const std::size_t count = std::min(sockets.size(), polled.size());
    for (std::size_t i = 0; i < count; ++i) {
        polled[i].fd = static_cast<int>(sockets[i].socket->handle());
        polled[i].events = static_cast<short>(POLLIN | (sockets[i].for_room ? POLLOUT : 0));
    }
    // A signal ends the wait early, as if nothing had come.
    const int ready = ::poll(polled.data(), static_cast<nfds_t>(count), std::max(at_most_ms, 0));
    for (std::size_t i = 0; i < count; ++i) {
        const int events = ready > 0 ? polled[i].revents : 0;
        const bool is_over = (events & (POLLERR | POLLHUP | POLLNVAL)) != 0;
        sockets[i].has_input = is_over || (events & POLLIN) != 0;
        sockets[i].has_room = is_over || (events & POLLOUT) != 0;
    }
}

}  // namespace palpa
