// Byte streams between programs (TCP). No call waits, but for wait_for_sockets. Errors are errno's,
// in std::generic_category, or the system's own where it has another list.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace palpa {

// The result of one read or write call.
struct SocketTransfer {
    std::size_t bytes = 0;    // 0: no data now, or no room
    bool is_ended = false;    // the other end has closed its side
    std::error_code error{};  // the connection is broken
};

// One end of a stream, or what waits for others to connect; closed with its owner.
class Socket {
public:
    Socket() = default;
    Socket(Socket&& other) noexcept : handle_(std::exchange(other.handle_, none)) {}
    Socket& operator=(Socket&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Socket() { close(); }

    // Begins to connect; wait_for_sockets says when there is room to write, and find_error then
    // whether it worked. `address` is of numbers (IPv4, IPv6) or "localhost": names are not looked
    // up, which could take seconds. Not open where `error` is set.
    static Socket connect(const std::string& address, std::uint16_t port, std::error_code& error);
    // Listens for connections; port 0 chooses a free one.
    static Socket listen(const std::string& address, std::uint16_t port, std::error_code& error);
    // The next connection of a listening socket; not open if there is none.
    Socket accept(std::error_code& error) const;

    bool is_open() const noexcept { return handle_ != none; }
    std::uint16_t find_port() const noexcept;  // port of this end; 0 if unknown
    std::error_code find_error() const noexcept;

    SocketTransfer read(std::span<std::byte> into) const noexcept;
    SocketTransfer write(std::span<const std::byte> bytes) const noexcept;
    // The other end reads to the end of what was written, and may still write.
    void end_writing() const noexcept;
    void close() noexcept;

    std::intptr_t handle() const noexcept { return handle_; }  // handle of the system

private:
    static constexpr std::intptr_t none = -1;
    explicit Socket(std::intptr_t handle) noexcept : handle_(handle) {}

    std::intptr_t handle_ = none;
};

// A socket that is waited for: until bytes or another socket can be taken from it, or its end;
// where `for_room`, also until it can be written.
struct AwaitedSocket {
    const Socket* socket = nullptr;
    bool for_room = false;
    // The result. After an error both are set, and the next call reports it.
    bool has_input = false;
    bool has_room = false;
};

// Returns once one is ready, and after `at_most_ms` at the latest; with none it only waits. At most
// 64 sockets.
void wait_for_sockets(std::span<AwaitedSocket> sockets, int at_most_ms);

}  // namespace palpa
