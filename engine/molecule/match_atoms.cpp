#include "molecule/match_atoms.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <cstddef>
#include <string>
#include <unordered_map>

namespace palpa {
namespace {

constexpr std::size_t several = static_cast<std::size_t>(-1);
constexpr std::size_t most_named = 8;  // of the atoms that are missing

std::string without_segment(const AtomName& name) {
    return name.residue + " " + name.number + " " + name.atom;
}

// The index of what bears a name, or `several`.
using Index = std::unordered_map<std::string, std::size_t>;

void add(Index& index, std::string name, std::size_t atom) {
    const auto [entry, is_new] = index.emplace(std::move(name), atom);
    if (!is_new) entry->second = several;
}

}  // namespace

std::vector<Vec3> match_positions(const Connectivity& connectivity, const Structure& structure) {
    Index exact, loose, wanted;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        add(exact, to_string(structure.names[i]), i);
        add(loose, without_segment(structure.names[i]), i);
    }
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        add(wanted, without_segment(connectivity.names[i]), i);
    }
    std::vector<Vec3> positions;
    std::vector<std::string> missing;
    for (const AtomName& name : connectivity.names) {
        auto found = exact.find(to_string(name));
        if (found != exact.end() && found->second == several) {
            throw LoadError({structure.file},
                            fmt::format("atom {} is there more than once, in alternate locations "
                                        "or models; expected one",
                                        to_string(name)));
        }
        if (found == exact.end() && wanted.at(without_segment(name)) != several) {
            found = loose.find(without_segment(name));
            if (found == loose.end() || found->second == several) found = exact.end();
        }
        if (found == exact.end()) {
            missing.push_back(to_string(name));
        } else {
            positions.push_back(structure.positions[found->second]);
        }
    }
    if (!missing.empty()) {
        const std::size_t others = missing.size() > most_named ? missing.size() - most_named : 0;
        missing.resize(missing.size() - others);
        throw LoadError({structure.file},
                        fmt::format("{} of {} are not there: {}{}", missing.size() + others,
                                    connectivity.file, fmt::join(missing, ", "),
                                    others > 0 ? fmt::format(" and {} more", others) : ""));
    }
    return positions;
}

}  // namespace palpa
