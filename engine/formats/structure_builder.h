// Shared by the readers of PDB and mmCIF: checks atoms one by one and gathers notes.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>

namespace palpa {

// Gathers the atoms of one file. Every call throws LoadError with file and line.
class StructureBuilder {
public:
    // `atoms`: number of atoms to reserve memory for.
    StructureBuilder(std::string file, std::size_t atoms);

    // Guesses the element where the record has none. An atom that comes again (the same model,
    // chain, segment, residue, number and insertion code, name, alternate location) is left out,
    // of which `Structure::doubts` has one. Refused are more than `most_repeated` of these, for
    // which MODEL, TER or chains may have been lost; one of another residue; an element that is
    // none.
    void add_atom(AtomName name, const Vec3& position, AtomRecord record, std::size_t line);

    static constexpr std::size_t most_repeated = 50;

    // Ignored beyond 100,000 links.
    void add_link(StructureLink link);

    // Adds a part of a residue's full name; long names come on several lines.
    void add_component_name(std::string_view residue, std::string_view name);

    // Ends a chain after the atoms so far.
    void end_chain();

    // A note on what may be wrong with the file.
    void add_doubt(std::string note);

    std::size_t atom_count() const noexcept { return structure_.names.size(); }

    // With notes on models, alternate locations, insertion codes, hetero atoms and guessed
    // elements. Refuses a file without atoms; `line` is its last.
    Structure build(std::size_t line);

private:
    void leave_out(const AtomName& name, const AtomRecord& record, std::size_t line,
                   std::size_t first);

    Structure structure_;
    std::unordered_map<std::string, std::size_t> atoms_;  // indices of the atoms
    std::size_t repeated_ = 0;
    std::string first_repeated_;  // as a sentence
};

}  // namespace palpa
