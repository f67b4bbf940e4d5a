#include "imd/messages.h"

#include "core/assertion.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t header_size = 8;

constexpr std::array<const char*, 17> type_names{
    "disconnect",    "energies", "coordinates", "go",     "handshake", "kill",
    "client forces", "pause",    "rate",        "error",  "session",   "resume",
    "time",          "box",      "velocities",  "forces", "wait"};

bool is_known(ImdType type) noexcept {
    const auto number = static_cast<std::int32_t>(type);
    return number >= 0 && number < static_cast<std::int32_t>(type_names.size());
}

template <std::size_t Size>
using Unsigned = std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>;

template <class Number>
Number read_number(const std::byte* bytes, std::endian order) noexcept {
    Unsigned<sizeof(Number)> bits = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
        const std::size_t at = order == std::endian::big ? i : sizeof(Number) - 1 - i;
        bits = bits << 8 | std::to_integer<Unsigned<sizeof(Number)>>(bytes[at]);
    }
    return std::bit_cast<Number>(bits);
}

template <class Number>
void add_number(ImdBytes& bytes, std::endian order, Number number) {
    const auto bits = std::bit_cast<Unsigned<sizeof(Number)>>(number);
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
        const std::size_t at = order == std::endian::big ? sizeof(Number) - 1 - i : i;
        bytes.push_back(static_cast<std::byte>(bits >> (8 * at) & 0xFF));
    }
}

void add_header(ImdBytes& bytes, ImdType type, std::size_t length) {
    add_number(bytes, std::endian::big, static_cast<std::int32_t>(type));
    add_number(bytes, std::endian::big, static_cast<std::int32_t>(length));
}

void add_floats(ImdBytes& bytes, std::endian order, std::span<const float> values) {
    bytes.reserve(bytes.size() + 4 * values.size());
    for (const float value : values) add_number(bytes, order, value);
}

std::vector<ImdType> list_announced(const ImdSession& session) {
    std::vector<ImdType> types;
    if (session.time) types.push_back(ImdType::Time);
    if (session.energies) types.push_back(ImdType::Energies);
    if (session.box) types.push_back(ImdType::Box);
    if (session.coordinates) types.push_back(ImdType::Positions);
    if (session.velocities) types.push_back(ImdType::Velocities);
    if (session.forces) types.push_back(ImdType::Forces);
    return types;
}

bool is_per_atom(ImdType type) noexcept {
    return type == ImdType::Positions || type == ImdType::Velocities || type == ImdType::Forces;
}

bool is_of_frame(ImdType type) noexcept {
    return is_per_atom(type) || type == ImdType::Energies || type == ImdType::Time ||
           type == ImdType::Box;
}

bool is_of_version_3(ImdType type) noexcept { return type >= ImdType::Session; }

// What may come from an engine beside frames; each of them ends the session.
bool ends_session(ImdType type) noexcept {
    return type == ImdType::Disconnect || type == ImdType::Kill || type == ImdType::Error;
}

bool is_command(ImdType type) noexcept {
    switch (type) {
        case ImdType::Disconnect:
        case ImdType::Kill:
        case ImdType::ClientForces:
        case ImdType::Pause:
        case ImdType::Rate:
        case ImdType::Resume:
        case ImdType::Wait:
            return true;
        default:
            return false;
    }
}

// In bytes; `length` is a number of atoms where it counts any.
std::size_t body_size_of(ImdType type, std::size_t length) noexcept {
    switch (type) {
        case ImdType::Energies:
            return 40;
        case ImdType::Session:
            return 7;
        case ImdType::Time:
            return 24;
        case ImdType::Box:
            return 36;
        case ImdType::Positions:
        case ImdType::Velocities:
        case ImdType::Forces:
            return 12 * length;
        case ImdType::ClientForces:
            return 16 * length;
        default:
            return 0;
    }
}

}  // namespace

std::string imd_name(ImdType type) {
    if (!is_known(type)) return fmt::format("type {}", static_cast<std::int32_t>(type));
    return type_names[static_cast<std::size_t>(type)];
}

ImdDecoder::ImdDecoder(bool is_of_engine, const ImdLimits& limits)
    : is_of_engine_(is_of_engine), limits_(limits) {}

ImdDecoder ImdDecoder::of_engine(const ImdLimits& limits) { return {true, limits}; }

ImdDecoder ImdDecoder::of_client(int version, std::endian order, const ImdLimits& limits) {
    ImdDecoder decoder(false, limits);
    decoder.version_ = version;
    decoder.order_ = order;
    return decoder;
}

std::size_t ImdDecoder::take(std::span<const std::byte> bytes) {
    std::size_t taken = 0;
    is_whole_ = false;
    while (problem_.empty() && !is_whole_) {
        const std::size_t size = is_in_body_ ? body_size_ : header_size;
        const auto part =
            bytes.subspan(taken, std::min(size - bytes_.size(), bytes.size() - taken));
        bytes_.insert(bytes_.end(), part.begin(), part.end());
        taken += part.size();
        if (bytes_.size() < size) break;
        if (is_in_body_) {
            read_body();
        } else {
            read_header();
            is_in_body_ = problem_.empty() && body_size_ > 0;
            bytes_.clear();
            if (is_in_body_) continue;
            if (message_.type == ImdType::ClientForces) read_client_forces();  // of no atoms
        }
        is_in_body_ = false;
        is_whole_ = problem_.empty();
        bytes_.clear();
    }
    return taken;
}

std::string ImdDecoder::find_place() const {
    if (is_in_body_) {
        return fmt::format("inside a '{}' message, after {} of {} bytes", imd_name(message_.type),
                           bytes_.size(), body_size_);
    }
    if (!bytes_.empty()) return fmt::format("inside a header, after {} of 8 bytes", bytes_.size());
    return "between two messages";
}

void ImdDecoder::refuse(std::string problem) {
    problem_ = std::move(problem);
    bytes_ = {};  // the memory too
}

void ImdDecoder::read_header() {
    message_.type =
        static_cast<ImdType>(read_number<std::int32_t>(bytes_.data(), std::endian::big));
    message_.number = read_number<std::int32_t>(bytes_.data() + 4, std::endian::big);
    message_.completes_frame = false;
    body_size_ = 0;
    if (!is_known(message_.type)) {
        return refuse(fmt::format("a message of type {} came, expected one from 0 to 16",
                                  static_cast<std::int32_t>(message_.type)));
    }
    if (message_.type == ImdType::Handshake && is_of_engine_ && version_ == 0) {
        return read_handshake();
    }
    check_order();
    if (problem_.empty()) check_length();
    if (!problem_.empty()) return;
    body_size_ = body_size_of(message_.type, static_cast<std::size_t>(message_.number));
    if (message_.type == ImdType::Go) is_ready_ = true;
}

// The version's byte order is the engine's; in the other order it is a large number.
void ImdDecoder::read_handshake() {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const auto version = read_number<std::int32_t>(bytes_.data() + 4, order);
        if (version != 2 && version != 3) continue;
        version_ = version;
        order_ = order;
        message_.number = version;
        is_ready_ = version == 2;
        return;
    }
    const auto little = read_number<std::uint32_t>(bytes_.data() + 4, std::endian::little);
    const auto big = read_number<std::uint32_t>(bytes_.data() + 4, std::endian::big);
    refuse(fmt::format("a handshake of version {} came, expected 2 or 3", std::min(little, big)));
}

void ImdDecoder::check_order() {
    const ImdType type = message_.type;
    const std::string name = imd_name(type);
    if (!is_of_engine_) {
        const bool is_expected =
            is_ready_ ? is_command(type) : type == ImdType::Go || type == ImdType::Disconnect;
        if (!is_expected) {
            return refuse(fmt::format("a '{}' message came, expected {}", name,
                                      is_ready_ ? "forces or a command" : "go"));
        }
    } else if (version_ == 0) {
        return refuse(fmt::format("a '{}' message came first, expected a handshake", name));
    } else if (!is_ready_) {
        if (type == ImdType::Session || ends_session(type)) return;
        return refuse(
            fmt::format("a '{}' message came after the handshake, expected the session", name));
    } else if (type == ImdType::Session || !(is_of_frame(type) || ends_session(type))) {
        return refuse(fmt::format("a '{}' message came, expected one of a frame", name));
    }
    if (version_ == 2 && is_of_version_3(type)) {
        return refuse(fmt::format("a '{}' message came, which version 2 does not have", name));
    }
    if (!is_of_engine_ || !is_of_frame(type)) return;
    if (version_ == 2) {
        message_.completes_frame = type == ImdType::Positions;
        return;
    }
    if (next_ == announced_.size() || announced_[next_] != type) {
        return refuse(fmt::format(
            "a '{}' message came, expected {}", name,
            announced_.empty() ? "none, as the session announced" : imd_name(announced_[next_])));
    }
    next_ = (next_ + 1) % announced_.size();
    message_.completes_frame = next_ == 0;
}

void ImdDecoder::check_length() {
    const std::int64_t length = message_.number;
    const auto refuse_length = [&](const std::string& expected) {
        refuse(fmt::format("a '{}' message came with a length of {}, expected {}",
                           imd_name(message_.type), length, expected));
    };
    switch (message_.type) {
        case ImdType::Energies:
        case ImdType::Time:
        case ImdType::Box:
            if (length != 1) refuse_length("1");
            return;
        case ImdType::Session:
            if (length != 7) refuse_length("7");
            return;
        case ImdType::Positions:
        case ImdType::Velocities:
        case ImdType::Forces:
            if (limits_.atoms == 0) {
                if (length < 1 || std::cmp_greater(length, limits_.max_atoms)) {
                    return refuse_length(fmt::format("1 to {} atoms", limits_.max_atoms));
                }
                limits_.atoms = static_cast<std::size_t>(length);
            } else if (std::cmp_not_equal(length, limits_.atoms)) {
                refuse_length(fmt::format("{} atoms", limits_.atoms));
                if (length > 0 && message_.type == ImdType::Positions)
                    other_atoms_ = static_cast<std::size_t>(length);
            }
            return;
        case ImdType::ClientForces:
            if (length < 0 || std::cmp_greater(length, limits_.atoms)) {
                refuse_length(fmt::format("0 to {} atoms", limits_.atoms));
            }
            return;
        default:
            return;  // any number: a rate, a wait, or nothing that is read
    }
}

void ImdDecoder::read_body() {
    const std::byte* at = bytes_.data();
    switch (message_.type) {
        case ImdType::Energies: {
            message_.energies.step = read_number<std::int32_t>(at, order_);
            ImdEnergies& to = message_.energies;
            const std::array<float*, 9> numbers{&to.temperature_kelvin,
                                                &to.total,
                                                &to.potential,
                                                &to.van_der_waals,
                                                &to.coulomb,
                                                &to.bonds,
                                                &to.angles,
                                                &to.dihedrals,
                                                &to.impropers};
            for (float* const number : numbers) {
                *number = read_number<float>(at += 4, order_);
                if (!std::isfinite(*number)) {
                    return refuse(
                        fmt::format("an energy of {} came, expected a finite one", *number));
                }
            }
            return;
        }
        case ImdType::Session: {
            std::array<bool, 7> flags{};
            std::transform(at, at + flags.size(), flags.begin(),
                           [](std::byte flag) { return flag != std::byte{0}; });
            message_.session = {flags[0], flags[1], flags[2], flags[3],
                                flags[4], flags[5], flags[6]};
            announced_ = list_announced(message_.session);
            is_ready_ = true;
            return;
        }
        case ImdType::Time:
            message_.time = {read_number<double>(at, order_), read_number<double>(at + 8, order_),
                             read_number<std::int64_t>(at + 16, order_)};
            if (!std::isfinite(message_.time.step_ps) || !std::isfinite(message_.time.now_ps)) {
                refuse(fmt::format("a time of {} ps in steps of {} ps came, expected finite ones",
                                   message_.time.now_ps, message_.time.step_ps));
            }
            return;
        case ImdType::Box:
            for (float& number : message_.box) {
                number = read_number<float>(at, order_);
                at += 4;
                if (!(std::abs(number) <= imd_farthest)) {
                    return refuse(fmt::format(
                        "a box with an edge of {} Å came, expected at most a million Å", number));
                }
            }
            return;
        case ImdType::Positions:
            return read_vectors(bytes_, imd_farthest, "numbers within a million Å");
        case ImdType::Velocities:
            return read_vectors(bytes_, std::numeric_limits<float>::max(), "finite numbers");
        case ImdType::Forces:
            return read_vectors(bytes_, std::numeric_limits<float>::max(), "finite numbers");
        default:
            return read_client_forces();
    }
}

void ImdDecoder::read_vectors(std::span<const std::byte> bytes, float largest,
                              const char* expected) {
    message_.values.resize(bytes.size() / 4);
    for (std::size_t i = 0; i < message_.values.size(); ++i) {
        const auto value = read_number<float>(bytes.data() + 4 * i, order_);
        if (!(std::abs(value) <= largest)) {
            return refuse(fmt::format("a '{}' message came with {} for its atom {}, expected {}",
                                      imd_name(message_.type), value, i / 3, expected));
        }
        message_.values[i] = value;
    }
}

void ImdDecoder::read_client_forces() {
    const std::size_t count = bytes_.size() / 16;
    message_.atoms.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto atom = read_number<std::int32_t>(bytes_.data() + 4 * i, order_);
        if (atom < 0 || std::cmp_greater_equal(atom, limits_.atoms)) {
            return refuse(fmt::format("a force on atom {} came, expected one from 0 to {}", atom,
                                      limits_.atoms - 1));
        }
        message_.atoms[i] = atom;
    }
    std::vector<std::int32_t> sorted = message_.atoms;
    std::ranges::sort(sorted);
    const auto twice = std::ranges::adjacent_find(sorted);
    if (twice != sorted.end()) {
        return refuse(fmt::format("two forces on atom {} came, expected one at most", *twice));
    }
    read_vectors(std::span(bytes_).subspan(4 * count), imd_strongest_pull,
                 "numbers within a million");
}

void add_imd_handshake(ImdBytes& bytes, int version, std::endian order) {
    add_number(bytes, std::endian::big, static_cast<std::int32_t>(ImdType::Handshake));
    add_number(bytes, order, std::int32_t{version});
}

void add_imd_session(ImdBytes& bytes, const ImdSession& session) {
    add_header(bytes, ImdType::Session, 7);
    for (const bool flag : {session.time, session.energies, session.box, session.coordinates,
                            session.is_wrapped, session.velocities, session.forces}) {
        bytes.push_back(static_cast<std::byte>(flag));
    }
}

void add_imd_energies(ImdBytes& bytes, std::endian order, const ImdEnergies& energies) {
    add_header(bytes, ImdType::Energies, 1);
    add_number(bytes, order, energies.step);
    add_floats(bytes, order,
               std::array{energies.temperature_kelvin, energies.total, energies.potential,
                          energies.van_der_waals, energies.coulomb, energies.bonds, energies.angles,
                          energies.dihedrals, energies.impropers});
}

void add_imd_time(ImdBytes& bytes, std::endian order, const ImdTime& time) {
    add_header(bytes, ImdType::Time, 1);
    add_number(bytes, order, time.step_ps);
    add_number(bytes, order, time.now_ps);
    add_number(bytes, order, time.step);
}

void add_imd_box(ImdBytes& bytes, std::endian order, const ImdBox& box) {
    add_header(bytes, ImdType::Box, 1);
    add_floats(bytes, order, box);
}

void add_imd_vectors(ImdBytes& bytes, std::endian order, ImdType type,
                     std::span<const float> values) {
    PALPA_ASSERT(is_per_atom(type) && values.size() % 3 == 0);
    add_header(bytes, type, values.size() / 3);
    add_floats(bytes, order, values);
}

void add_imd_client_forces(ImdBytes& bytes, std::endian order, std::span<const std::int32_t> atoms,
                           std::span<const float> values) {
    PALPA_ASSERT(values.size() == 3 * atoms.size());
    add_header(bytes, ImdType::ClientForces, atoms.size());
    for (const std::int32_t atom : atoms) add_number(bytes, order, atom);
    add_floats(bytes, order, values);
}

void add_imd_command(ImdBytes& bytes, ImdType type, std::int32_t number) {
    PALPA_ASSERT(body_size_of(type, 0) == 0);
    add_number(bytes, std::endian::big, static_cast<std::int32_t>(type));
    add_number(bytes, std::endian::big, number);
}

}  // namespace palpa
