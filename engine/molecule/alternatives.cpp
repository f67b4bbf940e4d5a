#include "molecule/alternatives.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <string>
#include <unordered_map>

namespace palpa {
namespace {

// " in location A in model 2"
std::string describe(const Structure& structure, std::size_t atom, bool with_model) {
    if (structure.records.empty()) return {};
    const AtomRecord& record = structure.records[atom];
    std::string text;
    if (record.alternate != ' ') text += fmt::format(" in location {}", record.alternate);
    if (with_model) text += fmt::format(" in model {}", record.model);
    return text;
}

}  // namespace

void refuse_alternative(const Structure& structure, std::size_t first, std::size_t again,
                        std::size_t count) {
    const bool with_model = !structure.records.empty() &&
                            structure.records[first].model != structure.records[again].model;
    throw LoadError(
        {structure.file, structure.lines[again], 0},
        fmt::format("atom {} is repeated{}, first{} on line {}{}; expected one position for each "
                    "atom (palpa prepare chooses one)",
                    to_string(structure.names[again]), describe(structure, again, with_model),
                    describe(structure, first, with_model), structure.lines[first],
                    count > 1 ? fmt::format(" ({} repeated lines)", count) : std::string()));
}

void refuse_alternatives(const Structure& structure) {
    if (structure.records.empty()) return;  // formats without either
    std::unordered_map<std::string, std::size_t> first_of;
    std::size_t first = 0, again = 0, count = 0;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        // Residues of several names in one place are alternatives too.
        const AtomName& name = structure.names[i];
        const auto [entry, is_new] =
            first_of.try_emplace(fmt::format("{} {} {} {}", structure.records[i].chain,
                                             name.segment, name.number, name.atom),
                                 i);
        if (is_new || count++ > 0) continue;
        first = entry->second;
        again = i;
    }
    if (count > 0) refuse_alternative(structure, first, again, count);
}

}  // namespace palpa
