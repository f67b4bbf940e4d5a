#include "charmm/residue_instances.h"

#include "core/text.h"

#include <fmt/format.h>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t none = ResidueInstance::none;

class InstanceBuilder {
public:
    InstanceBuilder(const ForceField& force_field, const Structure& structure,
                    const GenerateSettings& settings, Missing& missing)
        : force_field_(force_field),
          structure_(structure),
          settings_(settings),
          missing_(missing) {}

    ResidueInstances build() {
        collect_residues();
        set_up_segments();
        add_patches();
        add_disulphides();
        return std::move(result_);
    }

private:
    void collect_residues() {
        std::map<std::tuple<std::string, std::string, std::string>, std::size_t> index_of;
        std::map<std::string, std::size_t> last_of_segment;
        auto end = structure_.chain_ends.begin();
        for (std::uint32_t atom = 0; atom < structure_.names.size(); ++atom) {
            for (; end != structure_.chain_ends.end() && *end <= atom; ++end) {
                if (*end > 0) last_of_segment.erase(structure_.names[*end - 1].segment);
            }
            const AtomName& name = structure_.names[atom];
            const TextPlace place{structure_.file, structure_.lines[atom], 0};
            const auto [index, is_new] =
                index_of.try_emplace({name.segment, name.number, name.residue}, instances_.size());
            if (is_new) add_instance(name, place, last_of_segment);
            ResidueInstance& instance = instances_[index->second];
            if (!instance.present.emplace(name.atom, atom).second) {
                missing_.add(place, fmt::format("atom {} is repeated", to_string(name)));
            }
        }
    }

    void add_instance(const AtomName& name, const TextPlace& place,
                      std::map<std::string, std::size_t>& last_of_segment) {
        ResidueInstance instance;
        instance.name = name;
        instance.place = place;
        instance.residue = find_residue(force_field_, name.residue, place, missing_);
        instance.is_settled = instance.residue != nullptr;
        const std::size_t index = instances_.size();
        if (instance.residue) {
            for (const ResidueAtom& atom : instance.residue->atoms) {
                instance.wanted.emplace(atom.name, &atom);
            }
            result_.uses.push_back({instance.residue, {index}, ""});
        }
        const auto [last, is_first] = last_of_segment.try_emplace(name.segment, index);
        if (!is_first) {
            instance.previous = std::exchange(last->second, index);
            instances_[instance.previous].next = index;
        }
        instances_.push_back(std::move(instance));
    }

    void set_up_segments() {
        std::map<std::string, const SegmentSettings*> given;
        for (const SegmentSettings& segment : settings_.segments) {
            given[segment.segment] = &segment;
        }
        std::set<std::string> segments;
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const std::string& segment = instances_[i].name.segment;
            segments.insert(segment);
            const auto found = given.find(segment);
            set_up_ends(i, found == given.end() ? SegmentSettings{} : *found->second);
        }
        bool is_complete = true;
        for (const auto& [segment, settings] : given) {
            if (segments.contains(segment)) continue;
            is_complete = false;
            missing_.add({structure_.file}, fmt::format("no segment '{}' (only {})", segment,
                                                        fmt::join(segments, ", ")));
        }
        if (is_complete) return;
        // The settings may have been meant for any other segment.
        for (ResidueInstance& instance : instances_) {
            const bool is_end = instance.previous == none || instance.next == none;
            if (is_end && !given.contains(instance.name.segment)) instance.is_settled = false;
        }
    }

    void set_up_ends(std::size_t index, const SegmentSettings& settings) {
        ResidueInstance& instance = instances_[index];
        instance.has_generated_terms = settings.has_generated_terms;
        if (!instance.residue) return;
        const auto patch = [&](const std::string& named, const std::string& by_template) {
            const std::string& name = named.empty() ? by_template : upper_case(named);
            if (name != "NONE") apply_patch(name, {index}, instance.place);
        };
        if (instance.previous == none) patch(settings.first, instance.residue->first_patch);
        if (instance.next == none) patch(settings.last, instance.residue->last_patch);
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
            if (residues.empty()) continue;
            if (residues.size() < use.residues.size()) {
                unsettle(residues);
            } else {
                apply_patch(upper_case(use.patch), residues, instances_[residues[0]].place);
            }
        }
    }

    void add_disulphides() {
        std::vector<std::pair<std::size_t, std::uint32_t>> sulphurs;  // residue, its SG
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const ResidueInstance& instance = instances_[i];
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

    // Nothing more is said of these residues: it would follow from what is noted.
    void unsettle(const std::vector<std::size_t>& residues) {
        for (const std::size_t residue : residues) instances_[residue].is_settled = false;
    }

    void apply_patch(const std::string& name, const std::vector<std::size_t>& residues,
                     const TextPlace& place) {
        if (force_field_.residues.empty()) return;  // which is noted, and none is settled
        const auto found = force_field_.patches.find(name);
        if (found == force_field_.patches.end()) {
            missing_.add(place, fmt::format("no patch '{}' in {}{}", name,
                                            fmt::join(force_field_.files, ", "),
                                            near_name_hint(name, keys(force_field_.patches))));
            return unsettle(residues);
        }
        const Residue& patch = found->second;
        if (patch.lone_pair_line != 0) {
            missing_.add({patch.place.file, patch.lone_pair_line, 0},
                         fmt::format("patch '{}' has a lone pair, which is not supported", name));
            return unsettle(residues);
        }
        for (const std::size_t residue : residues) {
            if (!instances_[residue].residue) return unsettle(residues);
        }
        result_.uses.push_back({&patch, residues, name});
        delete_atoms(result_.uses.back(), place);
        change_atoms(result_.uses.back());
        for (const std::size_t residue : residues) instances_[residue].patches.push_back(name);
    }

    // The atom that a patch means; `residue` is none, which is noted, if it is given too few.
    AtomReference find_patched(const TemplateUse& use, std::string_view name) {
        const AtomReference reference = find_reference(result_, use, name);
        if (reference.residue == none) {
            missing_.add(use.residue->place,
                         fmt::format("patch '{}' names an atom '{}', but is applied to {} residues",
                                     use.patch, name, use.instances.size()));
            unsettle(use.instances);
        }
        return reference;
    }

    void delete_atoms(const TemplateUse& use, const TextPlace& place) {
        for (const std::string& name : use.residue->deleted_atoms) {
            const AtomReference reference = find_patched(use, name);
            if (reference.residue == none) continue;
            ResidueInstance& instance = instances_[reference.residue];
            const auto there = instance.wanted.find(reference.atom);
            if (there == instance.wanted.end()) {
                missing_.add(place, fmt::format("patch '{}' deletes an atom '{}' that {} lacks",
                                                use.patch, reference.atom, instance.label()));
                unsettle(use.instances);
                continue;
            }
            instance.wanted.erase(there);
            instance.deleted.emplace(reference.atom);
        }
    }

    void change_atoms(const TemplateUse& use) {
        for (const ResidueAtom& changed : use.residue->atoms) {
            const AtomReference reference = find_patched(use, changed.name);
            if (reference.residue == none) continue;
            ResidueInstance& instance = instances_[reference.residue];
            instance.wanted.insert_or_assign(std::string(reference.atom), &changed);
            const auto deleted = instance.deleted.find(reference.atom);
            if (deleted != instance.deleted.end()) instance.deleted.erase(deleted);
        }
    }

    const ForceField& force_field_;
    const Structure& structure_;
    const GenerateSettings& settings_;
    Missing& missing_;
    ResidueInstances result_;
    std::vector<ResidueInstance>& instances_ = result_.instances;
    std::set<std::size_t> patched_;  // instances with a patch given by name, or DISU
};

}  // namespace

std::string ResidueInstance::label() const {
    std::string text = fmt::format("{} {} {}", name.segment, name.residue, name.number);
    for (const std::string& patch : patches) text += fmt::format(" with {}", patch);
    return text;
}

ResidueInstances build_residue_instances(const ForceField& force_field, const Structure& structure,
                                         const GenerateSettings& settings, Missing& missing) {
    return InstanceBuilder(force_field, structure, settings, missing).build();
}

AtomReference find_reference(const ResidueInstances& residues, const TemplateUse& use,
                             std::string_view name) {
    const ResidueInstance& first = residues.instances[use.instances[0]];
    if (name.size() > 1 && (name[0] == '+' || name[0] == '-')) {
        return {name[0] == '+' ? first.next : first.previous, name.substr(1), true};
    }
    if (!use.patch.empty() && name.size() > 1 && name[0] >= '1' && name[0] <= '9') {
        const auto digit = static_cast<std::size_t>(name[0] - '1');
        return {digit < use.instances.size() ? use.instances[digit] : none, name.substr(1), false};
    }
    return {use.instances[0], name, false};
}

std::optional<std::uint32_t> find_atom(const ResidueInstances& residues, const TemplateUse& use,
                                       std::string_view name) {
    const AtomReference reference = find_reference(residues, use, name);
    if (reference.residue == none) return std::nullopt;
    const ResidueInstance& instance = residues.instances[reference.residue];
    const auto found = instance.present.find(reference.atom);
    return found == instance.present.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace palpa
