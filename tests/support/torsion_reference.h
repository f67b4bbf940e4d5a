// The torsion trees of the reference molecules, with the forces of their frames.
#pragma once
#include "tests/support/reference_case.h"
#include "tests/support/torsion_molecules.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace palpa::test {

// That of CASE.torsion.json.
inline TorsionCase read_torsion_case(const std::filesystem::path& folder, const std::string& name) {
    const nlohmann::json json = read_json(folder / (name + ".torsion.json"));
    TorsionCase c;
    const nlohmann::json force_field = read_json(folder / (name + ".ff.json"));
    for (const auto& row : force_field["atoms"]["rows"]) {
        c.masses.push_back(row[4]);
    }
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

}  // namespace palpa::test
