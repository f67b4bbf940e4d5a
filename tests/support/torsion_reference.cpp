#include "tests/support/torsion_reference.h"

#include "tests/support/read_json.h"
#include "tests/support/reference_case.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa::test {

namespace {

// rad/ps^2 of 1 kcal/mol / (amu Å^2)
constexpr double per_ps2 = 418.4;

}  // namespace

TorsionCase read_torsion_case(const std::filesystem::path& folder, const std::string& name) {
    const nlohmann::json json = read_json(folder / (name + ".torsion.json"));
    TorsionCase c;
    const ReferenceCase reference = read_reference_case(folder / (name + ".ff.json"));
    for (const ReferenceAtom& atom : reference.atoms) c.masses.push_back(atom.mass);
    c.bodies.body_of.resize(c.masses.size());
    for (const auto& body : json["bodies"]) {
        for (const std::uint32_t atom : body["atoms"]) {
            c.bodies.body_of[atom] = static_cast<std::uint32_t>(c.bodies.bodies.size());
        }
        c.bodies.bodies.push_back({});
        if (body["parent"] < 0) continue;
        c.bodies.bodies.back() = {body["parent"], {body["joint"][0], body["joint"][1]}};
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string file = entry.path().filename().string();
        if (!file.starts_with(name + ".") || file.ends_with(".ff.json") ||
            file.ends_with(".torsion.json"))
            continue;
        for (const ReferenceFrame& frame : read_reference_frames(entry.path())) {
            if (frame.name != json["frame"].get<std::string>()) continue;
            c.positions = frame.positions;
            c.forces = frame.forces;
        }
    }
    return c;
}

// The file gives a base's acceleration at its first atom, in rad/ps^2 and nm/ps^2.
TorsionAccelerations read_torsion_accelerations(const std::filesystem::path& folder,
                                                const std::string& name, const TorsionCase& c) {
    const nlohmann::json json = read_json(folder / (name + ".torsion.json"));
    const std::vector<Vec3> centres = centres_of(c);
    TorsionAccelerations result{std::vector<double>(c.bodies.bodies.size(), 0), {}};
    for (const auto& row : json["qdd"]) {
        result.joints[row[0].get<std::size_t>()] = row[1].get<double>() / per_ps2;
    }
    for (const auto& base : json["base"]) {
        Vec6 a;
        for (int i = 0; i < 3; ++i) {
            a[i] = base["angular"][i].get<double>() / per_ps2;
            a[i + 3] = base["linear"][i].get<double>() * angstrom_per_nm / per_ps2;
        }
        const std::uint32_t first = json["bodies"][base["body"].get<std::size_t>()]["atoms"][0];
        const Vec3 arm = centres[result.bases.size()] - c.positions[first];
        a.tail<3>() += a.head<3>().cross(arm);
        result.bases.push_back(a);
    }
    return result;
}

}  // namespace palpa::test
