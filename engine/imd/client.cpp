#include "imd/client.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t read_size = 1 << 16;
constexpr double leave_within_s = 1;

// As much as a poll reads: some frames, and always enough to get on.
std::size_t most_read(std::size_t atoms) noexcept { return (std::size_t{1} << 20) + 160 * atoms; }

}  // namespace

ImdClient::ImdClient(ImdClientOptions options)
    : options_(std::move(options)),
      units_(options_.units.value_or(ImdUnits{})),
      decoder_(ImdDecoder::of_engine(options_.limits)),
      builder_(units_),
      rate_(options_.rate) {}

ImdClient::~ImdClient() {
    if (phase_ == Phase::Running) say_farewell(Phase::Leaving);
}

void ImdClient::connect(double now_s) {
    if (phase_ == Phase::Running) say_farewell(Phase::Leaving);
    now_s_ = now_s;
    loss_.clear();
    begin();
}

void ImdClient::begin() {
    drop();
    since_s_ = now_s_;
    decoder_ = ImdDecoder::of_engine(options_.limits);
    session_ = {};
    frames_of_session_ = 0;
    pulled_.clear();
    is_paused_ = was_paused_ = false;
    sent_rate_ = 0;
    std::error_code error;
    socket_ = Socket::connect(options_.address, options_.port, error);
    if (error == std::errc::invalid_argument) {
        return lose("is not a numeric address such as 127.0.0.1", ImdLack::Answer);
    }
    if (error)
        return lose(fmt::format("does not accept the connection: {}", error.message()),
                    ImdLack::Answer);
    phase_ = Phase::Connecting;
    set_state(ImdState::Waiting, "has not accepted the connection yet");
}

void ImdClient::drop() {
    socket_.close();
    outgoing_.clear();
    sent_ = 0;
    pull_.reset();
}

void ImdClient::set_state(ImdState state, std::string why) {
    state_ = state;
    why_ = fmt::format("the engine at {}:{} {}", options_.address, options_.port, why);
    if (state != ImdState::Closed && !loss_.empty() && loss_ != why)
        why_ += "; before, it " + loss_;
}

// An engine that is still connected gets a farewell, and its bytes are read for a while longer:
// closing a socket with unread bytes would discard what was written last.
void ImdClient::lose(const std::string& why, ImdLack lack, bool is_ended) {
    const bool was_running = phase_ == Phase::Running;
    if (was_running) say_farewell(Phase::Leaving);
    if (!was_running || is_ended) {
        drop();
        phase_ = Phase::Lost;
    }
    since_s_ = now_s_;
    // An engine that ended over what was wrong at first cannot be connected to afterwards.
    const bool follows = lack == ImdLack::Answer && lack_ != ImdLack::Answer && !loss_.empty();
    if (!follows) {
        loss_ = why;
        lack_ = lack;
    }
    set_state(ImdState::Lost, why);
}

void ImdClient::finish_leaving(const char* how) {
    drop();
    phase_ = state_ == ImdState::Lost ? Phase::Lost : Phase::Closed;
    if (phase_ == Phase::Closed) set_state(ImdState::Closed, how);
}

bool ImdClient::poll(double now_s, int at_most_ms) {
    now_s_ = now_s;
    if (is_tried_again()) begin();
    wait(at_most_ms);
    if (phase_ == Phase::Connecting && has_room_) {
        if (const std::error_code error = socket_.find_error()) {
            lose(fmt::format("does not accept the connection: {}", error.message()),
                 ImdLack::Answer);
        } else {
            phase_ = Phase::Greeting;
            set_state(ImdState::Waiting, "is connected and has not sent its handshake");
        }
    }
    const bool is_newer = has_input_ && read();
    check_delay();
    if (phase_ == Phase::Running || phase_ == Phase::Leaving) write();
    return is_newer;
}

bool ImdClient::is_tried_again() const noexcept {
    return phase_ == Phase::Lost && options_.retry_after_s &&
           now_s_ - since_s_ >= *options_.retry_after_s;
}

void ImdClient::wait(int at_most_ms) {
    std::array<AwaitedSocket, 1> awaited{};
    awaited[0].socket = &socket_;
    awaited[0].for_room = phase_ == Phase::Connecting || sent_ < outgoing_.size();
    wait_for_sockets(std::span(awaited).first(socket_.is_open() ? 1 : 0), at_most_ms);
    has_input_ = awaited[0].has_input && phase_ != Phase::Connecting;
    has_room_ = awaited[0].has_room;
}

bool ImdClient::read() {
    std::array<std::byte, read_size>
        bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled
    bool is_newer = false;
    const std::size_t most = most_read(decoder_.atoms());
    for (std::size_t total = 0; total < most && socket_.is_open();) {
        const SocketTransfer got = socket_.read(bytes);
        if (phase_ == Phase::Leaving) {
            if (got.is_ended || got.error) finish_leaving("was disconnected normally");
        } else if (got.is_ended) {
            lose(fmt::format("closed the connection {}", decoder_.find_place()), ImdLack::Order,
                 true);
        } else if (got.error) {
            lose(fmt::format("lost the connection {}: {}", decoder_.find_place(),
                             got.error.message()),
                 ImdLack::Order, true);
        } else {
            is_newer |= take(std::span(bytes).first(got.bytes));
        }
        if (got.bytes == 0) break;
        total += got.bytes;
    }
    return is_newer;
}

bool ImdClient::take(std::span<const std::byte> bytes) {
    bool is_newer = false;
    while (!bytes.empty()) {
        bytes = bytes.subspan(decoder_.take(bytes));
        if (!decoder_.problem().empty()) {
            lose(fmt::format("was disconnected: {}", decoder_.problem()),
                 decoder_.other_atoms() > 0 ? ImdLack::Atoms : ImdLack::Order);
            break;
        }
        const ImdMessage* const message = decoder_.message();
        if (!message) break;
        if (message->type == ImdType::Handshake || message->type == ImdType::Session) {
            take_greeting();
        } else if (builder_.add(*message, frame_)) {
            is_newer = true;
            since_s_ = now_s_;
            ++frames_;
            ++frames_of_session_;
            loss_.clear();
            // The same molecule is expected when the engine comes back.
            options_.limits.atoms = decoder_.atoms();
        } else if (message->type == ImdType::Disconnect || message->type == ImdType::Kill ||
                   message->type == ImdType::Error) {
            lose(fmt::format("ended the session by a '{}' message", imd_name(message->type)),
                 ImdLack::Order);
        }
        if (phase_ != Phase::Greeting && phase_ != Phase::Running) break;
    }
    return is_newer;
}

void ImdClient::take_greeting() {
    if (!decoder_.is_ready()) return;
    if (options_.version && decoder_.version() != *options_.version) {
        return lose(fmt::format("was disconnected: it uses IMD version {}, expected {}",
                                decoder_.version(), *options_.version),
                    ImdLack::Version);
    }
    if (decoder_.version() == 3) session_ = decoder_.message()->session;
    if (decoder_.version() == 3 && !session_.coordinates) {
        return lose("was disconnected: its frames have no coordinates, expected coordinates",
                    ImdLack::Order);
    }
    units_ = options_.units.value_or(imd_units_of(decoder_.version()));
    builder_ = ImdFrameBuilder(units_);
    add_imd_command(outgoing_, ImdType::Go);
    phase_ = Phase::Running;
    lack_ = ImdLack::Frame;
    since_s_ = now_s_;
    set_state(ImdState::Waiting, "has not sent a frame yet");
}

void ImdClient::check_delay() {
    // A pause counts to its end, whenever that was.
    if (phase_ == Phase::Running && (is_paused_ || was_paused_at_check_)) since_s_ = now_s_;
    was_paused_at_check_ = is_paused_;
    const double passed_s = now_s_ - since_s_;
    switch (phase_) {
        case Phase::Connecting:
        case Phase::Greeting:
            if (passed_s > options_.answer_within_s) {
                lose(fmt::format("did not {} within {} s",
                                 phase_ == Phase::Connecting ? "answer" : "send its handshake",
                                 options_.answer_within_s),
                     phase_ == Phase::Connecting ? ImdLack::Answer : ImdLack::Handshake);
            }
            return;
        case Phase::Leaving:
            if (passed_s > leave_within_s)
                finish_leaving("was disconnected, but did not close its end");
            return;
        case Phase::Running:
            break;
        default:
            return;
    }
    if (frames_of_session_ == 0) return;
    if (passed_s <= options_.late_after_s) {
        set_state(ImdState::Connected, is_paused_ ? "is paused" : "sends frames");
    } else if (passed_s <= options_.lost_after_s) {
        // The hand cannot feel what these forces do.
        release_atoms();
        set_state(ImdState::Late, fmt::format("has not sent a frame for {:.1f} s", passed_s));
    } else {
        lose(fmt::format("has not sent a frame for {:.1f} s", passed_s), ImdLack::Order);
    }
}

std::string ImdClient::find_pull_problem(std::span<const std::int32_t> atoms,
                                         std::span<const Vec3> forces) const {
    if (state_ != ImdState::Connected) return why_;
    if (version() == 3 && !options_.pulls_in_version_3) {
        return "forces in IMD version 3 are experimental and were not switched on";
    }
    if (atoms.size() != forces.size()) {
        return fmt::format("{} forces for {} atoms, expected one for each atom", forces.size(),
                           atoms.size());
    }
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (atoms[i] < 0 || std::cmp_greater_equal(atoms[i], decoder_.atoms())) {
            return fmt::format("a force on atom {}, expected one from 0 to {}", atoms[i],
                               decoder_.atoms() - 1);
        }
        if (!forces[i].allFinite() ||
            units_.force * forces[i].cwiseAbs().maxCoeff() > imd_strongest_pull) {
            return fmt::format("a force of {} kcal/mol/Å on atom {}, expected a million at most",
                               forces[i].norm(), atoms[i]);
        }
    }
    std::vector<std::int32_t> sorted(atoms.begin(), atoms.end());
    std::ranges::sort(sorted);
    const auto twice = std::ranges::adjacent_find(sorted);
    if (twice == sorted.end()) return {};
    return fmt::format("two forces on atom {}, expected one at most", *twice);
}

std::string ImdClient::pull(std::span<const std::int32_t> atoms, std::span<const Vec3> forces) {
    std::string problem = find_pull_problem(atoms, forces);
    if (problem.empty()) {
        pull_ = Pull{{atoms.begin(), atoms.end()}, {forces.begin(), forces.end()}};
        write();
    }
    return problem;
}

void ImdClient::release_atoms() {
    pull_.reset();
    if (phase_ != Phase::Running || pulled_.empty()) return;
    pull_.emplace();
    write();
}

// With zeros for atoms that are let go.
void ImdClient::add_pull(const Pull& pull) {
    std::vector<std::int32_t> held = pull.atoms, atoms = pull.atoms;
    std::ranges::sort(held);
    std::ranges::sort(pulled_);
    std::ranges::set_difference(pulled_, held, std::back_inserter(atoms));
    if (atoms.empty()) return;
    std::vector<float> values = to_imd_forces(pull.forces, units_);
    values.resize(3 * atoms.size());
    add_imd_client_forces(outgoing_, decoder_.order(), atoms, values);
    pulled_ = pull.atoms;
    if (!pulled_.empty()) ++pulls_sent_;
}

// What an engine would go on with: forces, and in some of them a pause.
void ImdClient::say_farewell(Phase next) {
    phase_ = next;
    pull_.reset();
    add_pull({});
    if (was_paused_) {
        add_imd_command(outgoing_, decoder_.version() == 2 ? ImdType::Pause : ImdType::Resume);
        was_paused_ = false;
    }
    add_imd_command(outgoing_, ImdType::Disconnect);
    write();
}

// Only once all before has been sent: so it stays small, and what is sent is the newest.
void ImdClient::fill_outgoing() {
    outgoing_.clear();
    sent_ = 0;
    if (phase_ != Phase::Running) return;
    if (rate_ != sent_rate_) {
        add_imd_command(outgoing_, ImdType::Rate, rate_);
        sent_rate_ = rate_;
    }
    if (pull_) add_pull(*pull_);
    pull_.reset();
    if (is_paused_ != was_paused_) {
        const bool toggles = decoder_.version() == 2;
        add_imd_command(outgoing_, is_paused_ || toggles ? ImdType::Pause : ImdType::Resume);
        was_paused_ = is_paused_;
    }
}

void ImdClient::write() {
    while (socket_.is_open()) {
        if (sent_ == outgoing_.size()) fill_outgoing();
        if (outgoing_.empty()) {
            if (phase_ != Phase::Running) socket_.end_writing();
            return;
        }
        const SocketTransfer sent = socket_.write(std::span(outgoing_).subspan(sent_));
        sent_ += sent.bytes;
        if (sent.error) {
            outgoing_.clear();
            sent_ = 0;
            return;
        }
        if (sent.bytes == 0) return;
    }
}

void ImdClient::disconnect(double now_s) {
    now_s_ = since_s_ = now_s;
    if (phase_ != Phase::Running) {
        drop();
        phase_ = Phase::Closed;
        return set_state(ImdState::Closed, "was not connected");
    }
    say_farewell(Phase::Leaving);
    set_state(ImdState::Waiting, "is being left");
}

}  // namespace palpa
