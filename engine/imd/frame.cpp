#include "imd/frame.h"

#include <utility>

namespace palpa {
namespace {

void read_vectors(const std::vector<float>& values, double factor, std::vector<Vec3>& to) {
    to.resize(values.size() / 3);
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] = factor * Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    }
}

std::vector<float> to_floats(std::span<const Vec3> vectors, double factor) {
    std::vector<float> values;
    values.reserve(3 * vectors.size());
    for (const Vec3& vector : vectors) {
        for (const double number : vector) values.push_back(static_cast<float>(factor * number));
    }
    return values;
}

ImdEnergies scaled(ImdEnergies energies, double factor) {
    for (float* const energy :
         {&energies.total, &energies.potential, &energies.van_der_waals, &energies.coulomb,
          &energies.bonds, &energies.angles, &energies.dihedrals, &energies.impropers}) {
        *energy = static_cast<float>(factor * *energy);
    }
    return energies;
}

}  // namespace

ImdUnits imd_units_of(int version) noexcept {
    return version == 3 ? imd_units_of_version_3 : imd_units_of_namd;
}

std::optional<std::int64_t> ImdFrame::find_step() const noexcept {
    if (time) return time->step;
    if (energies) return energies->step;
    return std::nullopt;
}

bool ImdFrameBuilder::add(const ImdMessage& message, ImdFrame& frame) {
    switch (message.type) {
        case ImdType::Time:
            building_.time = message.time;
            break;
        case ImdType::Energies:
            building_.energies = scaled(message.energies, 1 / units_.energy);
            break;
        case ImdType::Box:
            building_.box = message.box;
            break;
        case ImdType::Positions:
            read_vectors(message.values, 1, building_.coordinates);
            break;
        case ImdType::Velocities:
            read_vectors(message.values, 1, building_.velocities);
            break;
        case ImdType::Forces:
            read_vectors(message.values, 1 / units_.force, building_.forces);
            break;
        default:
            return false;
    }
    if (!message.completes_frame) return false;
    // The memory of the frame before is that of the next one.
    std::swap(frame, building_);
    building_.time.reset();
    building_.energies.reset();
    building_.box.reset();
    building_.coordinates.clear();
    building_.velocities.clear();
    building_.forces.clear();
    return true;
}

void add_imd_frame(ImdBytes& bytes, int version, std::endian order, const ImdSession& session,
                   const ImdUnits& units, const ImdFrame& frame) {
    const std::size_t atoms = frame.coordinates.size();
    const auto add = [&](ImdType type, const std::vector<Vec3>& vectors, double factor) {
        std::vector<float> values = to_floats(vectors, factor);
        values.resize(3 * atoms);
        add_imd_vectors(bytes, order, type, values);
    };
    const auto add_energies = [&] {
        add_imd_energies(bytes, order,
                         scaled(frame.energies.value_or(ImdEnergies{}), units.energy));
    };
    if (version == 2) {
        if (frame.energies) add_energies();
        return add(ImdType::Positions, frame.coordinates, 1);
    }
    if (session.time) add_imd_time(bytes, order, frame.time.value_or(ImdTime{}));
    if (session.energies) add_energies();
    if (session.box) add_imd_box(bytes, order, frame.box.value_or(ImdBox{}));
    if (session.coordinates) add(ImdType::Positions, frame.coordinates, 1);
    if (session.velocities) add(ImdType::Velocities, frame.velocities, 1);
    if (session.forces) add(ImdType::Forces, frame.forces, units.force);
}

std::vector<float> to_imd_forces(std::span<const Vec3> forces, const ImdUnits& units) {
    return to_floats(forces, units.force);
}

}  // namespace palpa
