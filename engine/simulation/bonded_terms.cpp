#include "simulation/bonded_terms.h"

#include "charmm/build_topology.h"
#include "charmm/generate.h"
#include "core/load_error.h"
#include "simulation/components.h"
#include "simulation/solvent.h"

#include <fmt/format.h>
#include <map>
#include <memory>
#include <utility>

namespace palpa {
namespace {

// Checks that no two molecules are the same atoms.
void check_segments(const World& world) {
    const ScenePlaces& places = world.resource<ScenePlaces>();
    world.each<Molecule, Source>([&](Entity a, const Molecule& one, const Source& from) {
        world.each<Molecule, Source>([&](Entity b, const Molecule& other, const Source& source) {
            if (a == b || from.structure != source.structure || from.segment != source.segment)
                return;
            throw LoadError(
                places.place_of("molecules." + other.name + ".segment"),
                fmt::format("'{}' and '{}' are the same atoms (segment '{}'); expected each "
                            "segment only once in a scene with molecules that move by themselves",
                            one.name, other.name, from.segment));
        });
    });
}

}  // namespace

const BondedTerms& bonded_terms(World& world) {
    const BondedTerms& present = world.resource<BondedTerms>();
    if (present.topology) return present;
    check_segments(world);
    const ForceField& force_field = *world.resource<ForceFieldInUse>().force_field;
    // Several molecules may be of one file.
    std::map<const Structure*, std::shared_ptr<const Connectivity>> generated;
    auto all = std::make_shared<Connectivity>();
    world.write_each<Source, Molecule>([&](Entity, Source& source, const Molecule&) {
        if (!source.connectivity) {
            std::shared_ptr<const Connectivity>& of_file = generated[source.structure.get()];
            if (!of_file)
                of_file = std::make_shared<const Connectivity>(
                    build_connectivity(force_field, *source.structure));
            source.connectivity = of_file;
        }
        const Connectivity& from = *source.connectivity;
        const auto out = append_segment(from, source.segment, *all);
        if (!out) return;
        throw LoadError(
            {from.file, from.lines[(*out)[0]]},
            fmt::format(
                "atoms {} and {} of different segments are bonded; expected molecules without "
                "bonds between them in a scene with molecules that move by themselves",
                to_string(from.names[(*out)[0]]), to_string(from.names[(*out)[1]])));
    });
    auto topology = std::make_shared<Topology>(build_topology(*all, force_field));
    topology->solvation = find_solvation(world);
    return world.set_resource(BondedTerms{std::move(all), std::move(topology)});
}

}  // namespace palpa
