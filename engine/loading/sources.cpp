#include "loading/sources.h"

#include "charmm/build_topology.h"
#include "charmm/complete.h"
#include "charmm/generate.h"
#include "core/load_error.h"
#include "core/text.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/alternatives.h"
#include "prepare/build_positions.h"
#include "scene/find_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpa {
namespace {

template <class Content, class Read>
std::shared_ptr<const Content> find_or_read(
    std::map<std::filesystem::path, std::shared_ptr<const Content>>& files,
    const std::filesystem::path& path, const Read& read) {
    std::shared_ptr<const Content>& content = files[path];
    if (!content) content = std::make_shared<const Content>(read(path));
    return content;
}

Structure read_whole_structure(const std::filesystem::path& path) {
    Structure structure = read_structure(path);
    refuse_alternatives(structure);
    return structure;
}

// Lists segments in the order of their first atoms.
std::vector<std::string> list_segments(const std::vector<AtomName>& names) {
    std::vector<std::string> segments;
    for (const AtomName& name : names) {
        const bool is_known = (!segments.empty() && segments.back() == name.segment) ||
                              std::ranges::find(segments, name.segment) != segments.end();
        if (!is_known) segments.push_back(name.segment);
    }
    return segments;
}

// Quotes the names; only the first ones of very many.
std::string quote(std::vector<std::string> segments) {
    constexpr std::size_t most = 20;
    const std::size_t count = segments.size();
    segments.resize(std::min(count, most));
    const std::string all = fmt::format("'{}'", fmt::join(segments, "', '"));
    return count > most ? fmt::format("{} and {} more", all, count - most) : all;
}

std::string choose_segment(const Structure& structure, const std::string& wanted) {
    const std::vector<std::string> segments = list_segments(structure.names);
    if (segments.empty()) throw LoadError({structure.file}, "has no atoms; expected a molecule");
    if (wanted.empty() && segments.size() == 1) return segments.front();
    if (wanted.empty()) {
        throw LoadError({structure.file}, fmt::format("has {} segments, and none is named; "
                                                      "expected segment to be one of {}",
                                                      segments.size(), quote(segments)));
    }
    if (std::ranges::find(segments, wanted) == segments.end()) {
        throw LoadError({structure.file}, fmt::format("has no segment '{}'; expected one of {}",
                                                      wanted, quote(segments)));
    }
    return wanted;
}

std::shared_ptr<const Structure> extract(const Structure& from, const std::string& segment,
                                         const std::string& name) {
    auto structure = std::make_shared<Structure>();
    structure->file = from.file;
    auto end = from.chain_ends.begin();
    for (std::size_t i = 0; i < from.names.size(); ++i) {
        for (; end != from.chain_ends.end() && *end <= i; ++end)
            structure->chain_ends.push_back(structure->names.size());
        if (from.names[i].segment != segment) continue;
        structure->names.push_back(from.names[i]);
        structure->names.back().segment = name;
        structure->positions.push_back(from.positions[i]);
        structure->lines.push_back(from.lines[i]);
        structure->weights.push_back(b_factor_of(from, i));
    }
    return structure;
}

std::shared_ptr<const Connectivity> extract(const Connectivity& from, const std::string& segment,
                                            const std::string& name) {
    auto connectivity = std::make_shared<Connectivity>();
    connectivity->file = from.file;
    (void)append_segment(from, segment, *connectivity);
    for (AtomName& atom : connectivity->names) atom.segment = name;
    return connectivity;
}

}  // namespace

Source find_source(const std::filesystem::path& structure, const std::filesystem::path& topology,
                   const std::string& segment, SourceFiles& files) {
    Source source;
    source.structure = find_or_read(files.structures, structure, read_whole_structure);
    if (!topology.empty())
        source.connectivity = find_or_read(files.connectivities, topology, read_psf);
    source.segment = segment;
    return source;
}

Source find_engine_source(const std::filesystem::path& structure,
                          const std::filesystem::path& topology, const std::string& segment,
                          SourceFiles& files) {
    if (!is_topology(structure)) return find_source(structure, topology, segment, files);
    Source source;
    source.connectivity =
        find_or_read(files.connectivities, topology.empty() ? structure : topology, read_psf);
    source.structure = find_or_read(files.structures, structure, [&](const auto& path) {
        const Connectivity connectivity = read_psf(path);
        return Structure{.file = path.string(),
                         .names = connectivity.names,
                         .positions = std::vector<Vec3>(connectivity.names.size(), Vec3::Zero()),
                         .lines = connectivity.lines};
    });
    source.segment = segment;
    return source;
}

Source read_segment(const std::filesystem::path& structure, const std::filesystem::path& topology,
                    const std::string& segment, const std::string& name) {
    SourceFiles files;
    const Source whole = find_source(structure, topology, segment, files);
    const std::string chosen = choose_segment(*whole.structure, segment);
    Source source{extract(*whole.structure, chosen, name), nullptr, name};
    if (!whole.connectivity) return source;
    source.connectivity = extract(*whole.connectivity, chosen, name);
    if (source.connectivity->names.empty()) {
        throw LoadError(
            {whole.connectivity->file},
            fmt::format("has no segment '{}', which {} has; expected one of {}", chosen,
                        structure.string(), quote(list_segments(whole.connectivity->names))));
    }
    return source;
}

Source build_residue(const ForceField& force_field, const std::string& residue,
                     const std::string& name) {
    const auto found = force_field.residues.find(residue);
    if (found == force_field.residues.end() || found->second.atoms.empty()) {
        throw LoadError({"edit"}, fmt::format("the scene's force field has no residue '{}'; "
                                              "expected one of its files to name it (RESI)",
                                              residue));
    }
    Structure first;
    first.file = "residue " + residue;
    first.names.push_back({name, residue, "1", found->second.atoms.front().name});
    first.positions.emplace_back(Vec3::Zero());
    first.lines.push_back(0);
    auto whole = std::make_shared<Structure>(add_missing_atoms(force_field, first).structure);
    const Connectivity connectivity = build_connectivity(force_field, *whole);
    const Topology topology = build_topology(connectivity, force_field);
    const std::vector<AtomCoordinate> table = find_internal_coordinates(force_field, *whole);
    const BuiltPositions built = build_positions(connectivity, topology, table, whole->positions);
    if (!built.unplaced.empty()) {
        throw LoadError(
            {"edit"},
            fmt::format("residue '{}' has atoms without bonds; expected one molecule", residue));
    }
    return {std::move(whole), nullptr, name};
}

Source copy_source(const World& world, Entity molecule, const std::string& name) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const Molecule& of = *world.find<Molecule>(molecule);
    const Source& from = *world.find<Source>(molecule);
    auto structure = std::make_shared<Structure>();
    structure->file = from.structure->file;
    for (std::uint32_t i = of.atoms.first; i < of.atoms.first + of.atoms.count; ++i) {
        structure->names.push_back(atoms.names[i]);
        structure->names.back().segment = name;
        structure->positions.push_back(atoms.positions[i]);
        structure->lines.push_back(0);
    }
    Source source{structure, nullptr, name};
    if (from.connectivity) source.connectivity = extract(*from.connectivity, from.segment, name);
    return source;
}

}  // namespace palpa
