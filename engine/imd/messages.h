// The byte stream of IMD (interactive molecular dynamics), versions 2 and 3, between an engine that
// moves atoms and clients that watch and pull them. No sockets here.
//
// A message is a header of two int32, big-endian: type and length. Some types have a body, in the
// engine's byte order both ways; the handshake's second word, the version, is in that order too.
// An engine sends the handshake, in version 3 then what its frames will have; a client answers with
// Go within a second. Numbers here are as on the wire: Å, Å/ps and ps, energies and forces in units
// that depend on the engine (frame.h).
//
// Sources: IMD protocol version 3 as imdclient's documentation has it; for version 2, which has no
// specification, what NAMD, GROMACS and LAMMPS send and take.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpa {

enum class ImdType : std::int32_t {
    Disconnect,    // from a client; an engine just closes
    Energies,      // from the engine
    Positions,     // from the engine; "coordinates"
    Go,            // from a client, its answer to the handshake
    Handshake,     // from the engine; the version
    Kill,          // from a client: the engine should end
    ClientForces,  // from a client (also called MDComm)
    Pause,         // from a client; in version 2 a second one resumes
    Rate,          // from a client: steps between frames, less than 1 for the engine's own
    Error,         // never sent by engines in order
    Session,       // from the engine; this and all below in version 3 alone
    Resume,        // from a client
    Time,          // from the engine
    Box,           // from the engine
    Velocities,    // from the engine
    Forces,        // from the engine
    Wait,          // from a client: 0, the engine goes on without clients
};

// The name for messages, "coordinates"; "type 99" for unknown types.
std::string imd_name(ImdType type);

// Default port of clients, as in GROMACS and VMD.
inline constexpr std::uint16_t imd_port = 8888;

struct ImdEnergies {
    std::int32_t step = 0;
    float temperature_kelvin = 0;
    float total = 0, potential = 0;
    float van_der_waals = 0, coulomb = 0;
    float bonds = 0, angles = 0, dihedrals = 0, impropers = 0;

    bool operator==(const ImdEnergies&) const = default;
};

struct ImdTime {
    double step_ps = 0;  // from one step to the next
    double now_ps = 0;
    std::int64_t step = 0;

    bool operator==(const ImdTime&) const = default;
};

// Edges a, b and c of the periodic cell, three numbers each, Å.
using ImdBox = std::array<float, 9>;

// The content of each frame of a session, in this order.
struct ImdSession {
    bool time = false;
    bool energies = false;
    bool box = false;
    bool coordinates = false;
    bool is_wrapped = false;  // coordinates are wrapped into the box
    bool velocities = false;
    bool forces = false;

    bool operator==(const ImdSession&) const = default;
};

// One message. Fields that its type does not have keep their previous values.
struct ImdMessage {
    ImdType type = ImdType::Disconnect;
    std::int32_t number = 0;  // version, rate, wait; else the length
    bool completes_frame =
        false;  // whether it is the last one of its frame; in version 2, coordinates
    ImdEnergies energies;
    ImdTime time;
    ImdBox box{};
    ImdSession session;
    std::vector<std::int32_t> atoms;  // atoms of client forces, from 0, each at most once
    std::vector<float> values;  // x, y, z per atom: coordinates, velocities, forces, client forces
};

// Limits for what the other end may send.
struct ImdLimits {
    std::size_t atoms = 0;              // its number of atoms; 0: from its first message with atoms
    std::size_t max_atoms = 1'000'000;  // largest number of atoms
};

// Farther out, Å, or stronger, in the wire's unit, nothing is believed.
inline constexpr float imd_farthest = 1e6F;
inline constexpr float imd_strongest_pull = 1e6F;

// Takes bytes as they come and gives messages that are whole and checked: their order, lengths,
// numbers of atoms; all numbers finite, coordinates and edges within imd_farthest, client forces
// within imd_strongest_pull and of atoms that are there. After the first that is not so it takes
// nothing more. Holds no more than about four times the bytes of one message, of those that have
// come, whatever a header promises.
class ImdDecoder {
public:
    // Decodes what an engine sends; its handshake gives version and byte order.
    static ImdDecoder of_engine(const ImdLimits& limits);
    // Decodes what a client sends to an engine of `version` 2 or 3 with this byte order and
    // `limits.atoms` atoms.
    static ImdDecoder of_client(int version, std::endian order, const ImdLimits& limits);

    // Takes bytes to the end of the next message at most; how many. `message` stands until then.
    std::size_t take(std::span<const std::byte> bytes);
    // The message completed by the last call, or null.
    const ImdMessage* message() const noexcept { return is_whole_ ? &message_ : nullptr; }
    // What was received and what was expected; empty if there is no error.
    const std::string& problem() const noexcept { return problem_; }

    // Version of an engine; 0 before its handshake.
    int version() const noexcept { return version_; }
    std::endian order() const noexcept { return order_; }
    // Number of atoms; 0 until a message or the limits give it.
    std::size_t atoms() const noexcept { return limits_.atoms; }
    // Number of atoms of coordinates that were refused for it; else 0.
    std::size_t other_atoms() const noexcept { return other_atoms_; }
    // For an engine: whether "go" may be sent. In version 3 the session has arrived too.
    bool is_ready() const noexcept { return is_ready_; }
    // Where a stream that ends now would be cut: "inside a 'coordinates' message, after 12 of 36
    // bytes", or "between two messages".
    std::string find_place() const;

private:
    ImdDecoder(bool is_of_engine, const ImdLimits& limits);

    void read_header();
    void read_handshake();
    void check_order();
    void check_length();
    void read_body();
    void read_vectors(std::span<const std::byte> bytes, float largest, const char* expected);
    void read_client_forces();
    void refuse(std::string problem);

    bool is_of_engine_;
    ImdLimits limits_;
    std::size_t other_atoms_ = 0;
    int version_ = 0;
    std::endian order_ = std::endian::native;
    bool is_ready_ = false;           // of an engine: see above; of a client: it has said Go
    std::vector<ImdType> announced_;  // content of a frame of version 3, in order
    std::size_t next_ = 0;            // next of them

    std::vector<std::byte> bytes_;  // bytes of the incomplete header or body
    bool is_in_body_ = false;
    std::size_t body_size_ = 0;

    ImdMessage message_;
    bool is_whole_ = false;
    std::string problem_;
};

using ImdBytes = std::vector<std::byte>;

// Each appends one message. `order`: byte order of the engine.
void add_imd_handshake(ImdBytes& bytes, int version, std::endian order);
void add_imd_session(ImdBytes& bytes, const ImdSession& session);
void add_imd_energies(ImdBytes& bytes, std::endian order, const ImdEnergies& energies);
void add_imd_time(ImdBytes& bytes, std::endian order, const ImdTime& time);
void add_imd_box(ImdBytes& bytes, std::endian order, const ImdBox& box);
// Coordinates, velocities or forces, three numbers per atom.
void add_imd_vectors(ImdBytes& bytes, std::endian order, ImdType type,
                     std::span<const float> values);
// `values` has three numbers for each of `atoms`.
void add_imd_client_forces(ImdBytes& bytes, std::endian order, std::span<const std::int32_t> atoms,
                           std::span<const float> values);
// A message without a body: Disconnect, Go, Kill, Pause, Rate, Resume, Wait.
void add_imd_command(ImdBytes& bytes, ImdType type, std::int32_t number = 0);

}  // namespace palpa
