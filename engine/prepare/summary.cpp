#include "prepare/summary.h"

#include "core/translate.h"
#include "molecule/residue_kinds.h"
#include "prepare/report.h"
#include "prepare/system_segments.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace palpa {
namespace {

std::size_t count_residues(const Structure& structure, const SystemSegment& segment) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < segment.atoms.size(); ++i)
        count += i == 0 || !is_same_residue(structure.names[segment.atoms[i - 1]],
                                            structure.names[segment.atoms[i]]);
    return count;
}

// Counts chains of one length together, molecules of one residue by its name, waters by their
// number.
std::string describe_parts(const PreparedSystem& system) {
    struct Part {
        std::string name;
        std::size_t count = 0;
    };
    std::vector<Part> parts;
    const auto add = [&](std::string name) {
        const auto known = std::ranges::find(parts, name, &Part::name);
        if (known == parts.end())
            parts.push_back({std::move(name), 1});
        else
            ++known->count;
    };
    std::size_t waters = 0;
    for (const SystemSegment& segment : find_segments(system.structure, system.connectivity)) {
        const std::size_t residues = count_residues(system.structure, segment);
        const AtomName& first = system.structure.names[segment.atoms.front()];
        if (segment.kind == SegmentKind::Water) {
            waters += residues;
        } else if (segment.kind == SegmentKind::Molecule && residues > 1) {
            add(format_translated("chain of {} residues", residues));
        } else {
            add(first.residue);
        }
    }
    std::string text;
    for (const Part& part : parts)
        text += (text.empty() ? "" : ", ") +
                (part.count > 1 ? fmt::format("{} x {}", part.count, part.name) : part.name);
    if (waters > 0) text += (text.empty() ? "" : ", ") + format_translated("{} waters", waters);
    return text;
}

}  // namespace

PreparedSummary summarise(const PreparedSystem& system) {
    PreparedSummary summary;
    const std::size_t atoms = system.structure.names.size();
    summary.is = format_translated("{}; {} atoms", describe_parts(system), atoms);
    summary.added = system.built_hydrogens + system.built_heavy == 0
                        ? std::string(translated("nothing"))
                        : format_translated("{} hydrogens, {} other atoms", system.built_hydrogens,
                                            system.built_heavy);
    const auto& warnings = system.report.warnings();
    summary.look_first = warnings.empty() ? std::string(translated("nothing that needs a look"))
                                          : without_options(warnings.front());
    return summary;
}

}  // namespace palpa
