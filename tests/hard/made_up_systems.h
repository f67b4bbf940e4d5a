// Systems that no structure file holds: ions, waters, chains whose axes are in line, rings of
// disulphides.
#pragma once
#include "statics/torsion_state.h"
#include "tests/support/torsion_case.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace palpa::test {

// Atoms with Lennard-Jones numbers of oxygen or so, bonds where the positions have them.
class SystemBuilder {
public:
    std::uint32_t add_atom(double mass, double charge, const Vec3& position) {
        connectivity_.names.push_back({"A", "MADE", "1", "X"});
        connectivity_.mass.push_back(mass);
        positions_.push_back(position);
        topology_.charge.push_back(charge);
        topology_.type.push_back(0);
        return static_cast<std::uint32_t>(positions_.size() - 1);
    }

    void add_bond(std::uint32_t a, std::uint32_t b) {
        add_bond(a, b, (positions_[a] - positions_[b]).norm());
    }
    void add_bond(std::uint32_t a, std::uint32_t b, double length) {
        connectivity_.bonds.push_back({a, b});
        topology_.bonds.push_back({a, b, 300, length});
    }

    FlexibleCase take() {
        topology_.exclusions = build_exclusions(topology_.bonds, positions_.size());
        topology_.lennard_jones =
            build_lennard_jones_table(std::vector<LennardJonesType>{{0.1, 1.7}}, {});
        topology_.lennard_jones14 = topology_.lennard_jones;
        return {topology_, connectivity_, positions_};
    }

private:
    Topology topology_;
    Connectivity connectivity_;
    std::vector<Vec3> positions_;
};

inline FlexibleCase ions(const std::vector<Vec3>& places, double charge) {
    SystemBuilder builder;
    double sign = 1;
    for (const Vec3& place : places) {
        builder.add_atom(23, sign * charge, place);
        sign = -sign;
    }
    return builder.take();
}

// TIP3P, all turned alike.
inline FlexibleCase waters(const std::vector<Vec3>& places) {
    SystemBuilder builder;
    for (const Vec3& place : places) {
        const std::uint32_t o = builder.add_atom(15.9994, -0.834, place);
        for (const double side : {-1.0, 1.0}) {
            const Vec3 h(0.5859, side * 0.7570, 0);
            builder.add_bond(o, builder.add_atom(1.008, 0.417, place + h));
        }
    }
    return builder.take();
}

// Atoms along x, each with another `arm` (Å) beside the line. All bonds of the line turn, about one
// and the same axis. Without an arm only the two ends have one, of 1 Å.
inline FlexibleCase axes_in_line(std::size_t count, double arm) {
    SystemBuilder builder;
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 place(1.4 * static_cast<double>(i), 0, 0);
        const double angle = 1.1 * static_cast<double>(i), sign = i % 2 == 0 ? 1 : -1;
        const std::uint32_t atom = builder.add_atom(28.086, 0.2 * sign, place);
        if (i > 0) builder.add_bond(last, atom);
        last = atom;
        const bool is_end = i == 0 || i + 1 == count;
        const double beside = arm > 0 ? arm : is_end ? 1.0 : 0.0;
        if (beside == 0) continue;
        const Vec3 across(0.3, beside * std::cos(angle), beside * std::sin(angle));
        builder.add_bond(atom, builder.add_atom(18.998, -0.3 * sign, place + across));
    }
    return builder.take();
}

// -[S-CH2-CH2-CH2-S]- so often around; bonds between sulphurs are longer than they want to be.
inline FlexibleCase disulphide_ring(std::size_t units) {
    SystemBuilder builder;
    const std::size_t around = 5 * units;
    const double radius = 1.6 / (2 * std::sin(std::numbers::pi / static_cast<double>(around)));
    std::vector<std::uint32_t> ring;
    for (std::size_t i = 0; i < around; ++i) {
        const double angle =
            2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(around);
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const double up = i % 2 == 0 ? 0.4 : -0.4;
        const bool is_sulphur = i % 5 == 0 || i % 5 == 4;
        const Vec3 place = radius * out + up * Vec3::UnitZ();
        ring.push_back(builder.add_atom(is_sulphur ? 32.06 : 12.011, is_sulphur ? -0.1 : 0, place));
        if (is_sulphur) continue;
        for (const double side : {-0.6, 0.9}) {
            const Vec3 h = place + side * out + (up > 0 ? 0.7 : -0.7) * Vec3::UnitZ();
            builder.add_bond(ring.back(), builder.add_atom(1.008, 0.05, h));
        }
    }
    for (std::size_t i = 0; i < around; ++i) {
        const std::uint32_t a = ring[i], b = ring[(i + 1) % around];
        if (i % 5 == 4) builder.add_bond(a, b, 2.03);
        if (i % 5 != 4) builder.add_bond(a, b);
    }
    return builder.take();
}

}  // namespace palpa::test
