#include "charmm/generate.h"

#include "charmm/missing.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

// A residue of the structure, with what templates and patches make of it.
struct Instance {
    AtomName name;  // `atom` unused
    TextPlace place;
    const Residue* residue = nullptr;
    std::size_t previous = none, next = none;                       // in its chain
    std::map<std::string, std::uint32_t, std::less<>> present;      // atoms of the structure
    std::map<std::string, const ResidueAtom*, std::less<>> wanted;  // atoms it should have
    std::set<std::string, std::less<>> deleted;                     // by patches
    std::vector<std::string> patches;
    bool has_generated_terms = true;

    std::string label() const {
        std::string text = fmt::format("{} {} {}", name.segment, name.residue, name.number);
        for (const std::string& patch : patches) text += fmt::format(" with {}", patch);
        return text;
    }
};

// A template and the residues that it is used on: one, or those that a patch is given.
struct Use {
    const Residue* residue;
    std::vector<std::size_t> instances;
    bool is_patch;
};

class Generator {
public:
    Generator(const ForceField& force_field, const Structure& structure,
              const GenerateSettings& settings)
        : force_field_(force_field), structure_(structure), settings_(settings) {}

    Connectivity generate() {
        collect_residues();
        missing_.throw_if_any();  // without templates all else would follow from that
        set_up_segments();
        add_patches();
        add_disulphides();
        missing_.throw_if_any();
        add_atoms();
        missing_.throw_if_any();
        add_terms();
        missing_.throw_if_any();
        generate_angles();
        generate_dihedrals();
        return std::move(result_);
    }

private:
    void collect_residues() {
        std::map<std::tuple<std::string, std::string, std::string>, std::size_t> index_of;
        std::map<std::string, std::size_t> last_of_segment;
        for (std::uint32_t atom = 0; atom < structure_.names.size(); ++atom) {
            const AtomName& name = structure_.names[atom];
            const TextPlace place{structure_.file, structure_.lines[atom], 0};
            const auto [index, is_new] =
                index_of.try_emplace({name.segment, name.number, name.residue}, instances_.size());
            if (is_new) add_instance(name, place, last_of_segment);
            Instance& instance = instances_[index->second];
            if (!instance.present.emplace(name.atom, atom).second) {
                missing_.add(place, fmt::format("atom {} again", to_string(name)));
            }
        }
    }

    void add_instance(const AtomName& name, const TextPlace& place,
                      std::map<std::string, std::size_t>& last_of_segment) {
        Instance instance;
        instance.name = name;
        instance.place = place;
        instance.residue = find_residue(force_field_, name.residue, place, missing_);
        if (instance.residue) {
            for (const ResidueAtom& atom : instance.residue->atoms) {
                instance.wanted.emplace(atom.name, &atom);
            }
        }
        const std::size_t index = instances_.size();
        const auto [last, is_first] = last_of_segment.try_emplace(name.segment, index);
        if (!is_first) {
            instance.previous = std::exchange(last->second, index);
            instances_[instance.previous].next = index;
        }
        instances_.push_back(std::move(instance));
        uses_.push_back({instances_.back().residue, {index}, false});
    }

    void set_up_segments() {
        std::map<std::string, const SegmentSettings*> given;
        for (const SegmentSettings& segment : settings_.segments) {
            given[segment.segment] = &segment;
        }
        std::set<std::string> segments;
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const Residue& residue = *instances_[i].residue;
            const std::string& segment = instances_[i].name.segment;
            segments.insert(segment);
            const auto found = given.find(segment);
            const SegmentSettings settings =
                found == given.end() ? SegmentSettings{} : *found->second;
            instances_[i].has_generated_terms = settings.has_generated_terms;
            const auto patch = [&](const std::string& named, const std::string& by_template) {
                const std::string& name = named.empty() ? by_template : upper_case(named);
                if (name != "NONE") apply_patch(name, {i}, instances_[i].place);
            };
            if (instances_[i].previous == none) patch(settings.first, residue.first_patch);
            if (instances_[i].next == none) patch(settings.last, residue.last_patch);
        }
        for (const auto& [segment, settings] : given) {
            if (segments.contains(segment)) continue;
            missing_.add({structure_.file}, fmt::format("no segment '{}' (only {})", segment,
                                                        fmt::join(segments, ", ")));
        }
    }

    void add_patches() {
        std::map<std::pair<std::string, std::string>, std::size_t> index_of;
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const AtomName& name = instances_[i].name;
            index_of.try_emplace({name.segment, name.number}, i);
        }
        for (const PatchUse& use : settings_.patches) {
            std::vector<std::size_t> residues;
            for (const ResidueId& id : use.residues) {
                const auto found = index_of.find({id.segment, id.number});
                if (found == index_of.end()) {
                    missing_.add({structure_.file}, fmt::format("no residue {} {} for patch {}",
                                                                id.segment, id.number, use.patch));
                } else {
                    residues.push_back(found->second);
                    patched_.insert(found->second);
                }
            }
            if (residues.empty() || residues.size() < use.residues.size()) continue;
            apply_patch(upper_case(use.patch), residues, instances_[residues[0]].place);
        }
    }

    void add_disulphides() {
        std::vector<std::pair<std::size_t, std::uint32_t>> sulphurs;  // residue, its SG
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const Instance& instance = instances_[i];
            const auto sulphur = instance.present.find("SG");
            const bool is_free = instance.name.residue == "CYS" && !patched_.contains(i);
            if (is_free && sulphur != instance.present.end() && !instance.present.contains("HG1")) {
                sulphurs.emplace_back(i, sulphur->second);
            }
        }
        for (std::size_t i = 0; i < sulphurs.size(); ++i) {
            for (std::size_t j = i + 1; j < sulphurs.size(); ++j) {
                const auto& [first, a] = sulphurs[i];
                const auto& [second, b] = sulphurs[j];
                const double distance = (structure_.positions[a] - structure_.positions[b]).norm();
                if (!(distance < settings_.disulphide_distance)) continue;
                for (const std::size_t residue : {first, second}) {
                    if (patched_.insert(residue).second) continue;
                    missing_.add(
                        instances_[residue].place,
                        fmt::format("residue {} has two disulphide bonds within {} Å",
                                    instances_[residue].label(), settings_.disulphide_distance));
                }
                apply_patch("DISU", {first, second}, instances_[first].place);
            }
        }
    }

    // A name in a patch: its residue's place among those given, and the rest.
    static std::pair<std::size_t, std::string_view> split_digit(std::string_view name) {
        if (name.size() > 1 && name[0] >= '1' && name[0] <= '9') {
            return {static_cast<std::size_t>(name[0] - '1'), name.substr(1)};
        }
        return {0, name};
    }

    // The residue that a patch means by a name, and the atom's own name; none and noted if it is
    // given too few residues.
    std::pair<std::size_t, std::string_view> patched_atom(const Use& use, const std::string& patch,
                                                          std::string_view name) {
        const auto [digit, atom] = split_digit(name);
        if (digit < use.instances.size()) return {use.instances[digit], atom};
        missing_.add(use.residue->place,
                     fmt::format("patch '{}' has an atom '{}'; it is used on {} residues", patch,
                                 name, use.instances.size()));
        return {none, atom};
    }

    void apply_patch(const std::string& name, std::vector<std::size_t> residues,
                     const TextPlace& place) {
        const auto found = force_field_.patches.find(name);
        if (found == force_field_.patches.end()) {
            missing_.add(place, fmt::format("no patch '{}' in {}{}", name,
                                            fmt::join(force_field_.files, ", "),
                                            near_name_hint(name, keys(force_field_.patches))));
            return;
        }
        const Residue& patch = found->second;
        if (patch.lone_pair_line != 0) {
            missing_.add({patch.place.file, patch.lone_pair_line, 0},
                         fmt::format("patch '{}' has a lone pair, which is not supported", name));
            return;
        }
        uses_.push_back({&patch, std::move(residues), true});
        const Use& use = uses_.back();
        for (const std::string& deleted : patch.deleted_atoms) {
            const auto [residue, atom] = patched_atom(use, name, deleted);
            if (residue == none) continue;
            Instance& instance = instances_[residue];
            const auto there = instance.wanted.find(atom);
            if (there == instance.wanted.end()) {
                missing_.add(place, fmt::format("patch '{}' deletes an atom '{}' that {} lacks",
                                                name, atom, instance.label()));
                continue;
            }
            instance.wanted.erase(there);
            instance.deleted.emplace(atom);
        }
        for (const ResidueAtom& changed : patch.atoms) {
            const auto [residue, atom] = patched_atom(use, name, changed.name);
            if (residue == none) continue;
            instances_[residue].wanted.insert_or_assign(std::string(atom), &changed);
            const auto deleted = instances_[residue].deleted.find(atom);
            if (deleted != instances_[residue].deleted.end()) {
                instances_[residue].deleted.erase(deleted);
            }
        }
        for (const std::size_t residue : use.instances) instances_[residue].patches.push_back(name);
    }

    void add_atoms() {
        const std::size_t count = structure_.names.size();
        result_.file = structure_.file;
        result_.names = structure_.names;
        result_.lines = structure_.lines;
        result_.type.resize(count);
        result_.charge.resize(count);
        result_.mass.resize(count);
        residue_of_.resize(count);
        for (std::size_t i = 0; i < instances_.size(); ++i) add_atoms_of(i);
    }

    void add_atoms_of(std::size_t index) {
        const Instance& instance = instances_[index];
        for (const auto& [name, atom] : instance.present) {
            if (instance.wanted.contains(name)) continue;
            missing_.add({structure_.file, structure_.lines[atom], 0},
                         fmt::format("residue {} has no atom '{}'", instance.label(), name));
        }
        for (const auto& [name, numbers] : instance.wanted) {
            const auto found = instance.present.find(name);
            if (found == instance.present.end()) {
                missing_.add(instance.place,
                             fmt::format("residue {} lacks atom '{}'", instance.label(), name));
                continue;
            }
            const auto* const type =
                find_type(force_field_, numbers->type, numbers->place, missing_);
            if (!type) continue;
            const std::uint32_t atom = found->second;
            result_.type[atom] = type->first;
            result_.charge[atom] = numbers->charge;
            result_.mass[atom] = type->second.mass;
            residue_of_[atom] = index;
        }
    }

    // The atom that a template means, or nothing: a patch has deleted it, or the chain does not go
    // on with it. What it should have and has not is noted.
    std::optional<std::uint32_t> find_atom(const Use& use, std::string_view name) {
        std::size_t residue = use.instances[0];
        const bool is_neighbour = name.size() > 1 && (name[0] == '+' || name[0] == '-');
        if (is_neighbour) {
            residue = name[0] == '+' ? instances_[residue].next : instances_[residue].previous;
            name.remove_prefix(1);
        } else if (use.is_patch) {
            const auto [digit, atom] = split_digit(name);
            residue = digit < use.instances.size() ? use.instances[digit] : none;
            name = atom;
        }
        if (residue == none) return std::nullopt;
        const Instance& instance = instances_[residue];
        const auto found = instance.present.find(name);
        if (found != instance.present.end()) return found->second;
        if (!is_neighbour && !instance.deleted.contains(name)) {
            missing_.add(use.residue->place,
                         fmt::format("a term names atom '{}', which residue {} has not", name,
                                     instance.label()));
        }
        return std::nullopt;
    }

    // The tuples of a template whose atoms are all there.
    template <std::size_t Size>
    std::vector<std::array<std::uint32_t, Size>> find_tuples(
        const Use& use, const std::vector<std::array<std::string, Size>>& names) {
        std::vector<std::array<std::uint32_t, Size>> tuples;
        for (const auto& tuple : names) {
            std::array<std::uint32_t, Size> atoms{};
            bool is_whole = true;
            for (std::size_t i = 0; i < Size && is_whole; ++i) {
                const std::optional<std::uint32_t> atom = find_atom(use, tuple[i]);
                is_whole = atom.has_value();
                atoms[i] = atom.value_or(0);
            }
            if (is_whole) tuples.push_back(atoms);
        }
        return tuples;
    }

    template <std::size_t Size>
    static std::array<std::uint32_t, Size> lower_way(std::array<std::uint32_t, Size> atoms) {
        if (atoms.back() < atoms.front()) std::reverse(atoms.begin(), atoms.end());
        return atoms;
    }

    void add_terms() {
        std::set<std::array<std::uint32_t, 2>> bonded;
        for (const Use& use : uses_) {
            for (const auto& bond : find_tuples(use, use.residue->bonds)) {
                if (bonded.insert(lower_way(bond)).second) result_.bonds.push_back(bond);
            }
            for (const auto& angle : find_tuples(use, use.residue->angles)) {
                if (angles_.insert(lower_way(angle)).second) result_.angles.push_back(angle);
            }
            for (const auto& dihedral : find_tuples(use, use.residue->dihedrals)) {
                if (dihedrals_.insert(lower_way(dihedral)).second) {
                    result_.dihedrals.push_back(dihedral);
                }
            }
            for (const auto& deleted : find_tuples(use, use.residue->deleted_impropers)) {
                std::erase_if(result_.impropers, [&](const auto& improper) {
                    return lower_way(improper) == lower_way(deleted);
                });
            }
            for (const auto& improper : find_tuples(use, use.residue->impropers)) {
                result_.impropers.push_back(improper);
            }
            for (const auto& cmap : find_tuples(use, use.residue->cmaps)) {
                result_.cmaps.push_back(cmap);
            }
        }
        bonded_.resize(result_.names.size());
        for (const auto& [a, b] : result_.bonds) {
            bonded_[a].push_back(b);
            bonded_[b].push_back(a);
        }
        for (std::vector<std::uint32_t>& atoms : bonded_) std::sort(atoms.begin(), atoms.end());
    }

    bool has_generated_angles(std::uint32_t atom) const {
        const Instance& instance = instances_[residue_of_[atom]];
        return instance.has_generated_terms && instance.residue->has_generated_angles;
    }

    bool has_generated_dihedrals(std::uint32_t atom) const {
        const Instance& instance = instances_[residue_of_[atom]];
        return instance.has_generated_terms && instance.residue->has_generated_dihedrals;
    }

    // All pairs of bonds of an atom.
    void generate_angles() {
        if (!force_field_.generates_angles) return;
        for (std::uint32_t b = 0; b < bonded_.size(); ++b) {
            if (!has_generated_angles(b)) continue;
            for (std::size_t i = 0; i < bonded_[b].size(); ++i) {
                for (std::size_t j = i + 1; j < bonded_[b].size(); ++j) {
                    const std::array angle{bonded_[b][i], b, bonded_[b][j]};
                    if (!angles_.contains(angle)) result_.angles.push_back(angle);
                }
            }
        }
    }

    // All chains of three bonds; in a ring of three, whose ends would be one atom, there are none.
    void generate_dihedrals() {
        if (!force_field_.generates_dihedrals) return;
        for (std::uint32_t b = 0; b < bonded_.size(); ++b) {
            if (!has_generated_dihedrals(b)) continue;
            for (const std::uint32_t c : bonded_[b]) {
                if (c < b || !has_generated_dihedrals(c)) continue;
                for (const std::uint32_t a : bonded_[b]) {
                    for (const std::uint32_t d : bonded_[c]) {
                        if (a == c || d == b || a == d) continue;
                        const std::array dihedral{a, b, c, d};
                        if (!dihedrals_.contains(lower_way(dihedral))) {
                            result_.dihedrals.push_back(dihedral);
                        }
                    }
                }
            }
        }
    }

    const ForceField& force_field_;
    const Structure& structure_;
    const GenerateSettings& settings_;
    Missing missing_;
    std::vector<Instance> instances_;
    std::vector<Use> uses_;                // residues in their order, then patches
    std::set<std::size_t> patched_;        // instances with a patch given by name, or DISU
    std::vector<std::size_t> residue_of_;  // instance of each atom
    std::vector<std::vector<std::uint32_t>> bonded_;    // to each atom
    std::set<std::array<std::uint32_t, 3>> angles_;     // given by residues
    std::set<std::array<std::uint32_t, 4>> dihedrals_;  // likewise
    Connectivity result_;
};

}  // namespace

Connectivity build_connectivity(const ForceField& force_field, const Structure& structure,
                                const GenerateSettings& settings) {
    return Generator(force_field, structure, settings).generate();
}

}  // namespace palpa
