// Everything that an input lacks, gathered before it is reported.
#pragma once
#include "charmm/force_field.h"
#include "core/load_error.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// In the order in which it was found, each thing once; thrown as one LoadError. Its message names
// the first ones, and `LoadError::further` the others.
class Missing {
public:
    void add(const TextPlace& place, std::string what);
    void advise(std::string what);     // what stands once at the end of the message
    void add(const LoadError& error);  // another stage's problems, behind ours
    bool empty() const noexcept { return problems_.empty(); }
    std::size_t size() const noexcept { return problems_.size(); }
    void throw_if_any() const;

private:
    TextPlace place_;
    std::vector<std::string> problems_;
    std::vector<std::string> advice_;
    std::set<std::string> seen_;
};

// What helps where a structure is as it was downloaded.
inline constexpr const char* rename_advice = "`palpa prepare` gives atoms CHARMM's names";
inline constexpr const char* add_advice = "`palpa prepare` adds atoms";

// The names of a map, for near_name_hint.
template <class Map>
std::vector<std::string_view> keys(const Map& map) {
    std::vector<std::string_view> names;
    for (const auto& entry : map) names.emplace_back(entry.first);
    return names;
}

// The residue of this name, or null with the reason noted: it is unknown, or has lone pairs. Noted
// as well if its atoms do not add up to its charge. `place`: of what asks for it.
const Residue* find_residue(const ForceField& force_field, const std::string& name,
                            const TextPlace& place, Missing& missing);

// The same of an atom's type, by its name or its number.
const std::pair<const std::string, AtomType>* find_type(const ForceField& force_field,
                                                        const std::string& name,
                                                        const TextPlace& place, Missing& missing);

// And its Lennard-Jones parameters, by the type's name.
const NonbondedType* find_nonbonded(const ForceField& force_field, const std::string& type,
                                    const TextPlace& place, Missing& missing);

}  // namespace palpa
