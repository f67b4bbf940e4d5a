// Gathers all problems of an input, to report them together.
#pragma once
#include "charmm/force_field.h"
#include "core/load_error.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// The problems in the order in which they were found, each once; thrown as one LoadError
// (join_problems in core/load_error.h).
class Missing {
public:
    void add(const TextPlace& place, std::string what);
    void advise(std::string what);     // advice at the end of the message, each once
    void add(const LoadError& error);  // appends the problems of another stage
    bool empty() const noexcept { return problems_.empty(); }
    std::size_t size() const noexcept { return problems_.size(); }
    void throw_if_any() const;

private:
    TextPlace place_;
    std::vector<std::string> problems_;
    std::vector<std::string> advice_;
    std::set<std::string> seen_;
};

// Advice for structures as downloaded.
inline constexpr const char* rename_advice = "`palpa prepare` gives atoms CHARMM's names";
inline constexpr const char* add_advice = "`palpa prepare` adds atoms";

// The names of a map, for near_name_hint.
template <class Map>
std::vector<std::string_view> keys(const Map& map) {
    std::vector<std::string_view> names;
    for (const auto& entry : map) names.emplace_back(entry.first);
    return names;
}

// The residue of this name; null if it is unknown or has lone pairs, which is noted in `missing`.
// Also noted: charges that do not add up to the declared one. `place`: where the name is used.
const Residue* find_residue(const ForceField& force_field, const std::string& name,
                            const TextPlace& place, Missing& missing);

// The same for an atom type, by its name or number.
const std::pair<const std::string, AtomType>* find_type(const ForceField& force_field,
                                                        const std::string& name,
                                                        const TextPlace& place, Missing& missing);

// The Lennard-Jones parameters of a type, by its name.
const NonbondedType* find_nonbonded(const ForceField& force_field, const std::string& type,
                                    const TextPlace& place, Missing& missing);

}  // namespace palpa
