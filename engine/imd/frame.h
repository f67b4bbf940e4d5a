// Frames of IMD in the engine's units (Å, Å/ps, kcal/mol), and what remote engines have on the
// wire.
#pragma once
#include "core/units.h"
#include "imd/messages.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// How many of the wire's units are one kcal/mol, and one kcal/mol/Å; no handshake says so. Lengths
// are Å everywhere.
struct ImdUnits {
    double energy = 1;
    double force = 1;  // forces of clients and, in version 3, of frames
};

inline constexpr double kilojoule_per_kcal = units::joule_per_kcal / 1000;

// NAMD, and LAMMPS in its units "real" with an fscale of 1, which sends no energies. LAMMPS of
// 2025 converts nothing in version 3 either.
inline constexpr ImdUnits imd_units_of_namd{};
// GROMACS in version 2, of its sources (src/gromacs/imd/imd.cpp): forces of clients are kcal/mol/Å,
// which it converts, and energies its own, kJ/mol. So do runs of GROMACS 2022.5: 1 kcal/mol/Å on an
// atom of 40 amu gives it 10.46 Å/ps^2.
inline constexpr ImdUnits imd_units_of_gromacs{.energy = kilojoule_per_kcal};
// Version 3 as documented.
inline constexpr ImdUnits imd_units_of_version_3{.energy = kilojoule_per_kcal,
                                                 .force = kilojoule_per_kcal};

// Those of NAMD for version 2.
ImdUnits imd_units_of(int version) noexcept;

// What an engine says of one step: energies in kcal/mol, the box and coordinates in Å, velocities
// in Å/ps, forces in kcal/mol/Å. Empty, or without a value, is what it did not send.
struct ImdFrame {
    std::optional<ImdTime> time;
    std::optional<ImdEnergies> energies;
    std::optional<ImdBox> box;
    std::vector<Vec3> coordinates, velocities, forces;  // an entry per atom

    // Of the time, else of the energies.
    std::optional<std::int64_t> find_step() const noexcept;
};

// Assembles a frame from messages.
class ImdFrameBuilder {
public:
    explicit ImdFrameBuilder(const ImdUnits& units) : units_(units) {}

    // Returns true if the frame is complete; it is then in `frame`, and the next one begins.
    bool add(const ImdMessage& message, ImdFrame& frame);

private:
    ImdUnits units_;
    ImdFrame building_;
};

// Adds the messages of one frame. In version 2 these are its energies, where it has them, and its
// coordinates; in version 3 what the session names, zeros for what the frame lacks of it.
void add_imd_frame(ImdBytes& bytes, int version, std::endian order, const ImdSession& session,
                   const ImdUnits& units, const ImdFrame& frame);

// Converts forces of clients from kcal/mol/Å to the units of the connection.
std::vector<float> to_imd_forces(std::span<const Vec3> forces, const ImdUnits& units);

}  // namespace palpa
