#include "session/coordinates.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/crd.h"
#include "formats/gro.h"
#include "formats/mmcif.h"
#include "formats/pdb.h"
#include "formats/psf.h"
#include "simulation/components.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view exported = "Written by palpa export.";

enum class CoordinateFormat { Pdb, Mmcif, Gro, Crd, Psf };

CoordinateFormat format_of(const fs::path& file) {
    const std::string ending = upper_case(file.extension().string());
    if (ending == ".PDB" || ending == ".ENT") return CoordinateFormat::Pdb;
    if (ending == ".CIF" || ending == ".MMCIF") return CoordinateFormat::Mmcif;
    if (ending == ".GRO") return CoordinateFormat::Gro;
    if (ending == ".CRD" || ending == ".COR") return CoordinateFormat::Crd;
    if (ending == ".PSF") return CoordinateFormat::Psf;
    throw LoadError(
        {file.string()},
        fmt::format("'{}' is not the ending of a coordinate file; expected .pdb, .ent, .cif, "
                    ".mmcif, .gro, .crd, .cor, or .psf for a topology with its .crd",
                    file.extension().string()));
}

bool is_shown(const World& world, Entity molecule) {
    const Appearance* const appearance = world.find<Appearance>(molecule);
    return !appearance || appearance->visible;
}

// Of a residue number with its insertion code, "27A".
void read_number(const AtomName& name, AtomRecord& record) {
    std::string_view digits = name.number;
    std::optional<std::int64_t> number = find_integer(digits);
    if (!number && !digits.empty()) {
        record.insertion_code = digits.back();
        digits.remove_suffix(1);
        number = find_integer(digits);
    }
    if (!number || *number < -999'999'999 || *number > 999'999'999) {
        throw LoadError({"export"},
                        fmt::format("the residue number '{}' of {} is not valid; expected a whole "
                                    "number, with or without one letter after it",
                                    name.number, to_string(name)));
    }
    record.residue_number = static_cast<std::int32_t>(*number);
}

}  // namespace

Connectivity list_connectivity(const World& world) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::shared_ptr<const Connectivity>& known = world.resource<BondedTerms>().connectivity;
    if (known && has_same_atoms(atoms, *known)) return *known;
    Connectivity all;
    all.names = atoms.names;
    all.charge = atoms.charge;
    all.mass = atoms.mass;
    all.bonds = atoms.bonds;
    all.lines.assign(atoms.size(), 0);
    for (const std::uint32_t type : atoms.type) all.type.push_back(atoms.type_names[type]);
    return all;
}

bool has_same_atoms(const AtomTable& atoms, const Connectivity& known) noexcept {
    if (known.names.size() != atoms.size() || known.charge != atoms.charge ||
        known.mass != atoms.mass)
        return false;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (known.names[i].atom != atoms.names[i].atom ||
            !is_same_residue(known.names[i], atoms.names[i]) ||
            known.type[i] != atoms.type_names[atoms.type[i]])
            return false;
    }
    return true;
}

std::vector<std::uint32_t> select_atoms(const World& world,
                                        std::span<const std::string> molecules) {
    std::vector<std::string_view> names;
    world.each<Molecule>(
        [&](Entity, const Molecule& molecule) { names.emplace_back(molecule.name); });
    for (const std::string& wanted : molecules) {
        if (std::ranges::find(names, wanted) != names.end()) continue;
        throw LoadError({fmt::format("--of {}", wanted)},
                        fmt::format("is not a molecule of this scene; expected one of {}{}",
                                    fmt::join(names, ", "), near_name_hint(wanted, names)));
    }
    std::vector<std::uint32_t> atoms;
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        const bool is_wanted = molecules.empty()
                                   ? is_shown(world, entity)
                                   : std::ranges::find(molecules, molecule.name) != molecules.end();
        if (!is_wanted) return;
        for (std::uint32_t i = 0; i < molecule.atoms.count; ++i)
            atoms.push_back(molecule.atoms.first + i);
    });
    std::ranges::sort(atoms);
    if (atoms.empty())
        throw LoadError({"export"},
                        "no molecule is shown; expected --of and the name of a molecule");
    return atoms;
}

Structure build_structure(const World& world, std::span<const std::uint32_t> atoms) {
    const AtomTable& table = world.resource<AtomTable>();
    std::vector<std::uint32_t> ends;  // of molecules: the number behind the last atom
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        ends.push_back(molecule.atoms.first + molecule.atoms.count);
    });
    std::ranges::sort(ends);
    Structure structure;
    structure.file = "export";
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const std::uint32_t atom = atoms[i];
        structure.names.push_back(table.names[atom]);
        structure.positions.push_back(table.positions[atom]);
        AtomRecord record;
        record.serial = static_cast<std::int64_t>(i) + 1;
        record.chain = table.names[atom].segment;
        record.element = find_element(table, atom);
        record.element_guessed = table.element[atom].empty();
        record.b_factor = table.b_factor[atom];
        read_number(table.names[atom], record);
        structure.records.push_back(std::move(record));
        if (std::ranges::binary_search(ends, atom + 1)) structure.chain_ends.push_back(i + 1);
    }
    return structure;
}

std::vector<TextFile> format_coordinates(const World& world, std::span<const std::uint32_t> atoms,
                                         const fs::path& file, std::string_view title) {
    const CoordinateFormat format = format_of(file);
    const Structure structure = build_structure(world, atoms);
    const std::string marked = fmt::format("{}\n{}", exported, title);
    switch (format) {
        case CoordinateFormat::Pdb:
            return {{file, format_pdb(with_short_chains(structure), marked)}};
        case CoordinateFormat::Mmcif:
            return {{file, fmt::format("# {}\n{}", exported,
                                       format_mmcif(structure, file.stem().string()))}};
        case CoordinateFormat::Gro:
            return {{file, format_gro(structure, fmt::format("{} {}", exported, title))}};
        case CoordinateFormat::Crd:
            return {{file, format_crd(structure, marked)}};
        case CoordinateFormat::Psf:
            break;
    }
    Connectivity chosen;
    (void)append_atoms(list_connectivity(world), atoms, chosen);
    const std::vector<fs::path> files = list_coordinate_files(file);
    return {{files[0], format_psf(chosen, marked)}, {files[1], format_crd(structure, marked)}};
}

std::vector<fs::path> list_coordinate_files(const fs::path& file) {
    if (format_of(file) != CoordinateFormat::Psf) return {file};
    fs::path beside = file;
    return {file, beside.replace_extension(".crd")};
}

std::string coordinates_mark(const fs::path& file) {
    switch (format_of(file)) {
        case CoordinateFormat::Pdb:
            return fmt::format("REMARK   1 {}", exported);
        case CoordinateFormat::Mmcif:
            return fmt::format("# {}", exported);
        case CoordinateFormat::Gro:
            return std::string(exported);
        case CoordinateFormat::Crd:
            return fmt::format("* {}", exported);
        case CoordinateFormat::Psf:
            break;
    }
    return fmt::format(" REMARKS {}", exported);
}

}  // namespace palpa
